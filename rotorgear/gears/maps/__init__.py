"""Contact maps: the loaded contact of a tooth pair tabulated over position and load, and over tilt."""
