"""What scatter and search say of a design."""
