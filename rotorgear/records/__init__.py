"""Records of measured channels over time, from the files of those who measured them."""
