"""Is a freshly printed text the one that stands on the page?

The words must be equal; runs of blanks and of line-drawing characters may differ in length. Numbers must agree to 1e-6
relative or show the same digits; from five printed digits up the last one may differ by one, because it may round
either way on another machine. Seconds are never compared: a number before `s` or `seconds`, or after the word
`seconds`, as in "in 0.42 s" and `"seconds": 0.42`, a number before `CPU s`, and a number before `ms of CPU`; nor is
what went into compilation, which is told where a cache was empty.
On a page, `...` within a line stands for any text, and a line that is only `...` for any lines.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator

ELLIPSIS = "..."
_NUMBER = r"(?<![A-Za-z_0-9.])[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?"
_TOKEN = re.compile(
    rf"(?P<after>\bseconds\b[\"']?\s*[:=|]?\s*)(?P<late>{_NUMBER})"
    rf"|(?P<early>{_NUMBER})(?=\s*(?:(?:CPU )?(?:s|seconds)\b(?!\s*[/^*])|ms of CPU\b))"
    rf"|(?P<number>{_NUMBER})|(?P<any>\.\.\.)|(?P<rule>[-─━═]{{3,}})|(?P<blank>\s+)"
)


def numbers_agree(page: str, printed: str) -> bool:
    """Whether two printed numbers are the same number."""
    a = float(page)
    b = float(printed)
    if a == b or re.fullmatch(r"[-+]?\d+", page):  # a whole number is a count or a name: exact
        return a == b
    mantissa, _, exponent = page.lower().partition("e")
    digits = mantissa.lstrip("+-0.").replace(".", "")
    last_place = 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
    allowed = 1.001 * last_place if len(digits) >= 5 else 0.0
    return abs(a - b) <= max(allowed, 1e-6 * max(abs(a), abs(b)))


def lines_agree(page: str, printed: str) -> bool:
    """Whether one printed line is the one on the page."""
    pattern, numbers = _pattern(page.strip())
    found = re.fullmatch(pattern, printed.strip())
    return found is not None and all(map(numbers_agree, numbers, found.groups()))


def _pattern(line: str) -> tuple[str, list[str]]:
    """Return a regular expression for a line of the page, with a group for every number, and the numbers."""
    parts: list[str] = []
    numbers: list[str] = []
    place = 0
    for token in _TOKEN.finditer(line):
        parts.append(re.escape(line[place : token.start()]))
        place = token.end()
        if token["after"] is not None:
            head = re.sub(r"(?:\\\s|\s)+", r"\\s*", re.escape(token["after"]))
            parts.append(head + _NUMBER)
        elif token["early"]:
            parts.append(_NUMBER)
        elif token["number"]:
            numbers.append(token["number"])
            parts.append(f"({_NUMBER})")
        else:
            parts.append(".*?" if token["any"] else r"[-─━═]{3,}" if token["rule"] else r"\s+")
    parts.append(re.escape(line[place:]))
    return "".join(parts), numbers


def texts_agree(page: str, printed: str) -> bool:
    """Whether a printed text is the one on the page, line by line."""
    old = page.rstrip().splitlines()
    # What a first run says of its compilation stands on no page.
    printed = re.sub(r"^[\w-]+: compiling, once, .*\n", "", printed, flags=re.MULTILINE)
    new = re.sub(r" \(and [\d.]+ of compilation, once\)", "", printed).rstrip().splitlines()
    reachable = {0}  # how many printed lines the lines of the page so far can stand for
    for line in old:
        if line.strip() == ELLIPSIS:
            reachable = set(range(min(reachable), len(new) + 1))
        else:
            reachable = {k + 1 for k in reachable if k < len(new) and lines_agree(line, new[k])}
        if not reachable:
            return False
    return len(new) in reachable


def difference(page: str, printed: str) -> str:
    """Return the two texts as a unified difference, for a message."""
    rows = difflib.unified_diff(
        page.rstrip().splitlines(), printed.rstrip().splitlines(), "on the page", "printed now", lineterm=""
    )
    return "\n".join(rows)


def merged(page: str, printed: str) -> str | None:
    """Return the printed text with the gaps (`...` lines) of the page, or None where a gap's ends can't be found again.

    The first stretch of the page keeps its length from the top and the last one its length from the bottom; a stretch
    between begins where its first line comes back, whatever its numbers.
    """
    new = printed.rstrip().splitlines()
    stretches = list(_stretches(page.rstrip().splitlines()))
    if len(stretches) == 1:
        return "\n".join(new)
    if any(ELLIPSIS in line for stretch in stretches for line in stretch):
        return None
    result: list[str] = []
    place = 0
    for k, stretch in enumerate(stretches):
        last = k == len(stretches) - 1
        if not stretch or k == 0:
            start = place
        elif last:
            start = len(new) - len(stretch)
        else:
            start = next((j for j in range(place, len(new)) if _words(new[j]) == _words(stretch[0])), -1)
        end = len(new) if last and stretch else start + len(stretch)
        if start < place or end > len(new):
            return None
        result += [*([ELLIPSIS] if k else []), *new[start:end]]
        place = end
    return "\n".join(result)


def _stretches(lines: list[str]) -> Iterator[list[str]]:
    """Split the lines of a page at its gaps."""
    stretch: list[str] = []
    for line in lines:
        if line.strip() == ELLIPSIS:
            yield stretch
            stretch = []
        else:
            stretch.append(line)
    yield stretch


def _words(line: str) -> str:
    """Return a line without its numbers and blanks."""
    return re.sub(rf"{_NUMBER}|\s+", "", line)
