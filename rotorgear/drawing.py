"""How a result finds its picture, the one on `rotorgear.plot` that is named as its kind, and the page that a notebook shows.

Results stand below pictures and know none of them. So the face, which stands above both, hands the way up in here.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

Picture = Callable[..., Any]
_ways: list[Callable[[str], Picture | None]] = []
_pages: list[Callable[[], Picture]] = []


def found_by(way: Callable[[str], Picture | None], page: Callable[[], Picture]) -> None:
    """Say how the picture of a kind of result is found, None for a kind without one; and what makes a page of a result."""
    _ways[:] = [way]
    _pages[:] = [page]


def page_of(result: Any) -> Any:
    """A result as a page in a notebook."""
    return _pages[0]()(result)


def picture_of(kind: str) -> Picture:
    """The function that draws results of a kind.

    Raises:
        AnalysisError: nothing draws them.
    """
    picture = _ways[0](kind) if _ways else None
    if picture is None:
        # Not above: the face imports this file, and the errors bring dataclasses along, which cost more than all the rest.
        from rotorgear.errors import AnalysisError

        raise AnalysisError(f"a result of the kind '{kind}' has no picture; its table and its numbers say it all")
    return picture
