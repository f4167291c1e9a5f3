"""Numbers of a model within bounds, so that excitations keep away from the modes that they excite."""
