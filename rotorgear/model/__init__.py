"""The model: named parts as the file has them, their checks, and the gear train that follows from them."""
