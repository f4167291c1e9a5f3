"""Arrays as plain values for JSON."""

from __future__ import annotations

from typing import Any

import numpy as np


def plain(values: np.ndarray) -> list[Any]:
    """Nested lists of floats; what is not finite becomes None."""
    if values.ndim > 1:
        return [plain(row) for row in values]
    return [float(value) if np.isfinite(value) else None for value in values]
