"""Tables of comparison with test rigs, updating by them, places of sensors."""
