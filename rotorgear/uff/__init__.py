"""Universal files (UFF) of modal-test programs: datasets 15, 55, 58, 58b, 82 and 164, between bytes and arrays."""
