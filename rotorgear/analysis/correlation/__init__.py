"""Measured shapes, frequency responses, order cuts and spectral lines beside a model, and the places of their sensors."""
