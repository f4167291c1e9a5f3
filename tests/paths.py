"""Where the repository and its models are, for tests at any depth."""

from __future__ import annotations

from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
MODELS = ROOT / "models"
VALIDATION = ROOT / "validation" / "cases"
SOUND = ROOT / "tests" / "sound"

# Their teeth, or their casing, are computed by finite elements first, which takes longer than most tests.
COSTLY = {"elastic_wheel", "helicopter", "overhung_pinion", "split_torque_casing"}
SHIPPED = [
    pytest.param(path, id=path.stem, marks=[pytest.mark.long] if path.stem in COSTLY else [])
    for path in sorted(MODELS.glob("*.toml"))
]
