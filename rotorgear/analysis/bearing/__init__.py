"""Sheets of bearings, and how far their numbers are to be trusted."""
