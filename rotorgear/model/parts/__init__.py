"""The parts of a model file: frozen classes whose fields carry unit, bounds and meaning."""
