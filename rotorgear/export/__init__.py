"""Writers of results: VTK, HDF5, JSON."""
