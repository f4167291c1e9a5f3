"""Mean and varying mesh stiffness: given, ISO 6336-1, contact lines, potential energy; dynamic factor K_v."""
