"""Points of the unit cube, and variances from them."""
