"""Local force laws, one a file: relative displacements in, forces and tangents out. Nothing here knows of degrees of freedom."""
