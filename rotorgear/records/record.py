"""A record: channels that were measured together, over one time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Channel:
    """A measured channel: its name and unit as the file has them ("" where it has none), and its values (n,) in that unit."""

    name: str
    unit: str
    values: NDArray[np.float64]


@dataclass(frozen=True)
class TimeRecord:
    """Channels over one time in s, (n,), rising; `notes` say what the file left open."""

    time: NDArray[np.float64]
    channels: tuple[Channel, ...]
    notes: tuple[str, ...] = ()


def over_one_time(tracks: list[tuple[Channel, NDArray[np.float64]]]) -> TimeRecord:
    """Channels with a time each as one record: over the time of the densest one, where all of them were measured.

    Args:
        tracks: channels with their times in s, rising.
    """
    time = min((own for _, own in tracks), key=lambda own: float(np.median(np.diff(own))) if len(own) > 1 else np.inf)
    others = [own for _, own in tracks if own is not time and not np.array_equal(own, time)]
    if not others:
        return TimeRecord(time, tuple(channel for channel, _ in tracks))
    first, last = (pick(own[end] for _, own in tracks) for pick, end in ((max, 0), (min, -1)))
    time = time[(time >= first) & (time <= last)]
    channels = tuple(
        Channel(channel.name, channel.unit, np.interp(time, own, channel.values)) for channel, own in tracks
    )
    note = f"{len(others)} of {len(tracks)} channels were measured at other times: taken from those by straight lines"
    return TimeRecord(time, channels, (note,))
