"""Tables of what scatter and search say of a design."""
