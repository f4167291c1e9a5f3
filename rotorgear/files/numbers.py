"""Numbers as texts: Arabic digits with a decimal point, as the pages write them, and nothing else that Python takes.

Python reads 1_0 as 10, digits of any script, and whole numbers of any length; a file or an option means none of these.
"""

from __future__ import annotations

import re

NUMBER = r"[+-]?(?:[0-9]++(?:\.[0-9]*+)?|\.[0-9]++)(?:[eE][+-]?[0-9]++)?"
_NUMBER = re.compile(NUMBER)
_WORD = re.compile(r"[+-]?(?:inf(?:inity)?|nan)", re.IGNORECASE)
_WHOLE = re.compile(r"[+-]?[0-9]++")
_DIGITS = re.compile(r"[0-9]++")
_LONGEST = 100
# Whole numbers with more digits fit into no array.
_MOST_DIGITS = 18


def number_of(text: str, *, words: bool = False) -> float:
    """The number that a text is, with blanks around it.

    Args:
        text: such as "-1.5e-3".
        words: whether inf and nan count too.

    Raises:
        ValueError: anything else.
    """
    plain = text.strip() if len(text) <= _LONGEST else ""
    if not (_NUMBER.fullmatch(plain) or (words and _WORD.fullmatch(plain))):
        raise ValueError(f"'{text[:40]}' is no number")
    return float(plain)


def whole_of(text: str) -> int:
    """The whole number that a text is, with blanks around it.

    Raises:
        ValueError: anything else, or more digits than an array takes.
    """
    plain = text.strip() if len(text) <= _LONGEST else ""
    if not _WHOLE.fullmatch(plain) or len(plain.lstrip("+-0")) > _MOST_DIGITS:
        raise ValueError(f"'{text[:40]}' is no whole number")
    return int(plain)


def is_count(text: str) -> bool:
    """Whether a text is a whole number without a sign that `whole_of` reads."""
    return bool(_DIGITS.fullmatch(text)) and len(text.lstrip("0")) <= _MOST_DIGITS and len(text) <= _LONGEST
