"""Measured shapes, frequency responses and order cuts beside a model, and the places of their sensors."""
