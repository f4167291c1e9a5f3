"""Frozen outputs: what every verb says of every shipped model, number for number, before and after a change."""
