"""Analyses: verbs that take a model and return a frozen result."""
