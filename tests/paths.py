"""Where the repository and its models are, for tests at any depth."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
MODELS = ROOT / "models"
VALIDATION = ROOT / "validation"
SOUND = ROOT / "tests" / "sound"
