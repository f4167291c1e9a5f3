"""Five published gear systems: every printed number beside the computed one, with a verdict.

`NAME.csv` holds the rows of a system, `NAME.py` computes its values from the model in models/, `rows.py` puts both together:
python -m validation.seeds [NAME ...]
"""
