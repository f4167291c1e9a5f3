"""The sentence of a result on something that it left out."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

import numpy as np

import rotorgear as rg
from tests.models import spur_pair


def sentence(result: Any, *words: str) -> str:
    """The one sentence of a result, or of sentences, that has all these words."""
    found = [text for text in sentences(result) if all(word in text for word in words)]
    assert len(found) == 1, (words, sentences(result))
    return found[0]


def says(result: Any, *words: str) -> bool:
    """Whether a sentence of a result has all these words."""
    return any(all(word in text for word in words) for text in sentences(result))


def sentences(result: Any) -> list[str]:
    return list(getattr(result, "left_out", result))


def numbers(text: str) -> list[float]:
    """All numbers in a sentence that stand by themselves."""
    return [float(x) for x in re.findall(r"(?<![\w.])[-+]?\d+\.?\d*(?:e[-+]?\d+)?(?![\w])", text)]


def modes(model: rg.Model, **more: Any) -> np.ndarray:
    """Eigenvalues of the lowest modes, one element a segment."""
    return rg.modal(model, **{"modes": 8, "elements": 1, "error_estimate": False, **more}).eigenvalues


def pair(mesh: Iterable[tuple[str, Any]] = (), **changes: Any) -> rg.Model:
    """The spur pair without its transmission error, with changes of its mesh."""
    return spur_pair(
        **{"meshes__pair__transmission_error": [], **{f"meshes__pair__{key}": value for key, value in mesh}, **changes}
    )
