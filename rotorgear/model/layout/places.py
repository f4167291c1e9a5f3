"""A place on a shaft."""

from __future__ import annotations

from typing import NamedTuple


class Place(NamedTuple):
    """Name of a shaft and z on it in m."""

    shaft: str
    z: float
