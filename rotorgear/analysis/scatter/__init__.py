"""Scatter of uncertain numbers: bands of frequencies, margins and load shares, and which number makes them."""
