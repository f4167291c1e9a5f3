"""How many modes a modal analysis may be asked for."""

from __future__ import annotations

import numpy as np

from rotorgear.analysis.modal.mode_count import expected_modes
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model

# More modes than this are a slip of the pen, and their shapes would fill the memory.
MOST_MODES = 2000


def check_count(model: Model, fmax: float) -> None:
    """Refuse a frequency below which there are more modes than anyone reads, before they are sought."""
    expected = expected_modes(model, 2.0 * np.pi * fmax)
    if expected > MOST_MODES:
        raise AnalysisError(
            f"about {expected:.2g} modes lie below {fmax:g} Hz, more than {MOST_MODES}; ask for a lower frequency (--fmax)"
        )
