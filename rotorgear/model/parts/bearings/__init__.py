"""Bearings by their geometry: the kinds of which a force law is made, each with its keys, its law and its checks."""
