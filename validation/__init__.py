"""Validation: cases with their sources, one folder each, and the runner that compares them with rotorgear.

A case is a folder with `expected.csv`, `README.md` (where the numbers come from) and its model files. `cases.py` reads it,
`measure.py` solves the models, `runner.py` judges and prints:  python -m validation [CASE ...]
"""
