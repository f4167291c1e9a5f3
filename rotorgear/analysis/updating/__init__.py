"""Updating free numbers of a model by what rigs measured: misfit, steps towards the most probable numbers, campaigns."""
