"""Colours of lines and bars that colour-blind readers tell apart, dark enough on white (Okabe and Ito)."""

from __future__ import annotations

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#555555", "#8B4513")
