"""A model file with some of its numbers multiplied: everything else, comments and units too, stays as the user wrote it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from rotorgear.errors import AnalysisError
from rotorgear.extras import require

_NUMBER = re.compile(r"\s*[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
# Digits that a written number keeps; more would pretend.
_DIGITS = 6
# Of a Fourier series only the mean is a size; amplitudes are shares of it.
_MEAN = "mean"


def scaled_text(
    text: str,
    factors: Mapping[str, float],
    remarks: Mapping[str, str] | None = None,
    texts: Mapping[str, str] | None = None,
) -> str:
    """Return the text of a model file with the values at some addresses times a factor.

    Args:
        text: of the file (TOML).
        factors: address, such as "bearings.left.stiffness" or "shafts.rotor.sections[0].length", -> factor.
        texts: address -> what is written in place of a value that is 0 or a word such as "start", which no factor moves.
        remarks: address -> comment to put behind the new value, before the old comment.

    Raises:
        AnalysisError: an address that the file does not spell out, or a value that is no number.
        MissingExtraError: tomlkit is not installed.
    """
    require("tomlkit", "Writing a changed model file")
    import tomlkit

    document = tomlkit.parse(text)
    for address in [*factors, *(name for name in texts or {} if name not in factors)]:
        *owners, last = re.sub(r"\[(\d+)\]", r".\1", address).split(".")
        owner: Any = document
        for key in owners:
            owner = _below(owner, key, address)
        old = _below(owner, last, address)
        place: Any = int(last) if isinstance(owner, list) else last
        comment = old.trivia.comment.lstrip("# ") if hasattr(old, "trivia") else ""
        fixed = (texts or {}).get(address)
        owner[place] = fixed if fixed is not None and _stays(old) else _times(old, factors[address], address)
        remark = "; ".join(part for part in ((remarks or {}).get(address, ""), comment) if part)
        if remark and not isinstance(owner, list | tomlkit.items.InlineTable):
            owner[place].comment(remark)
    return tomlkit.dumps(document)


def _stays(value: Any) -> bool:
    """Whether no factor moves a value: a word, or 0."""
    if not isinstance(value, str):
        return not isinstance(value, dict | list) and float(value) == 0.0
    number = _NUMBER.match(value)
    return number is None or float(number[0]) == 0.0


def _below(owner: Any, key: str, address: str) -> Any:
    try:
        return owner[int(key)] if isinstance(owner, list) else owner[key]
    except (KeyError, IndexError, ValueError, TypeError):
        raise AnalysisError(
            f"{address}: the file does not spell this value out, so it can't be written there"
        ) from None


def _times(value: Any, factor: float, address: str) -> Any:
    """A number, a text that begins with one, or several of them, times a factor."""
    if isinstance(value, dict):
        scaled = {_MEAN: value[_MEAN]} if _MEAN in value else value
        table = value.copy()
        for key, entry in scaled.items():
            table[key] = _times(entry, factor, address)
        return table
    if isinstance(value, list):
        return [_times(entry, factor, address) for entry in value]
    if isinstance(value, str):
        number = _NUMBER.match(value)
        if number is None:
            raise AnalysisError(f"{address}: '{value}' is no number, so it can't be scaled")
        return f"{float(number[0]) * factor:.{_DIGITS}g}{value[number.end() :]}"
    return float(f"{float(value) * factor:.{_DIGITS}g}")
