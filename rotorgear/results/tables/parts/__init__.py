"""Tables of sheets of single parts: gears and their meshes, bearings, casings."""
