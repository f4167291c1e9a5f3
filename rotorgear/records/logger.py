"""Records in the files of measuring systems: MDF4 (ASAM), TDMS (National Instruments) and WAV, by packages that read them.

What such a file says of its size is bounded before its numbers are read, and what it packs is bounded before it is unpacked.
Formulas that MDF4 may hold are not run: of its conversions a factor and an offset are taken.
"""

from __future__ import annotations

import gc
import json
import logging
import os
import re
import struct
import subprocess
import sys
import traceback
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from rotorgear.errors import ModelError, Problem
from rotorgear.extras import require
from rotorgear.files.bounds import MOST_SAMPLES, RECORD
from rotorgear.files.read import UnreadableError, named_file, opened
from rotorgear.records.record import Channel, TimeRecord, over_one_time

Track = tuple[Channel, NDArray[np.float64]]
# Package that reads each kind of file.
PACKAGES = {".mf4": "asammdf", ".mdf": "asammdf", ".tdms": "nptdms", ".wav": "soundfile"}
_TITLES = {"asammdf": "MDF4", "nptdms": "TDMS", "soundfile": "WAV"}
# A packed block of MDF4: head, what it was before, how it is packed, sizes before and after.
_PACKED = struct.Struct("<4s4xQQ2sBBIQQ")
_DEFLATE = (0, 1)
_NO_CONVERSION = 0
_LINEAR = 1
_OPEN = 0xFFFFFFFF  # size of a WAV that nobody has filled in
_BREAKS_OFF = "it ends before what it says it holds"
_TIMES = (2, 3)  # types of a channel of MDF4 that is the time itself


def read_logged(path: str | Path) -> TimeRecord:
    """Return the record in a file of MDF4, TDMS or WAV, by the ending of its name.

    Raises:
        MissingExtraError: the package that reads it is not installed.
        ModelError: a file that can't be read, or that is no such file; no channels; more numbers than are read.
    """
    file = Path(path)
    package = PACKAGES[file.suffix.lower()]
    title = _TITLES[package]
    require(package, f"Reading {title}")
    if package == "asammdf":
        return _read_apart(file)
    return over_one_time(_tracks(file))


def _read_apart(file: Path) -> TimeRecord:
    """A record of MDF4, read by a process of its own: a broken file may end the one that reads it.

    Raises:
        ModelError: as `read_logged` says.
    """
    expected = "a file of MDF4"
    try:
        named_file(file, RECORD.most_bytes)
    except UnreadableError as error:
        raise ModelError([Problem(file.name, "", expected, error.reason)], str(file)) from None
    # Modules from where this process has them, and none from the current folder.
    found_at = os.pathsep.join(str(Path(place).resolve()) for place in sys.path if place)
    command = [sys.executable, "-P", "-m", "rotorgear.records.logger", str(file.resolve())]
    done = subprocess.run(command, capture_output=True, env={**os.environ, "PYTHONPATH": found_at}, check=False)
    head, _, data = done.stdout.partition(b"\n")
    if done.returncode or not head:
        raise ModelError([Problem(file.name, "", f"{expected} that is whole", "what reads it broke off")], str(file))
    told = json.loads(head)
    if "expected" in told:
        raise ModelError([Problem(file.name, told["value"], told["expected"], told["hint"])], str(file))
    time, *values = np.frombuffer(data, dtype="<f8").reshape(len(told["channels"]) + 1, -1).copy()
    channels = [Channel(name, unit, own) for (name, unit), own in zip(told["channels"], values, strict=True)]
    return TimeRecord(time, tuple(channels), tuple(told["notes"]))


def _write_apart(path: str) -> None:
    """Write a record, or why it can't be read, to the process that asked for it: a line of JSON, then all numbers."""
    answer = os.dup(1)
    os.dup2(2, 1)  # what the package prints of the file is no part of the answer
    try:
        found = over_one_time(_tracks(Path(path)))
    except ModelError as error:
        (problem,) = error.problems
        told: dict[str, Any] = {"value": problem.value, "expected": problem.expected, "hint": problem.hint}
        table = np.zeros(0)
    else:
        told = {"channels": [[one.name, one.unit] for one in found.channels], "notes": list(found.notes)}
        table = np.array([found.time, *(one.values for one in found.channels)])
    with os.fdopen(answer, "wb") as out:
        out.write(json.dumps(told).encode() + b"\n" + table.astype("<f8").tobytes())


def _tracks(file: Path) -> list[Track]:
    """The channels of a file, each with its time; errors as of `read_logged`."""
    package = PACKAGES[file.suffix.lower()]
    title = _TITLES[package]
    reader = {"asammdf": _of_mdf, "nptdms": _of_tdms, "soundfile": _of_wav}[package]
    logging.getLogger("asammdf").setLevel(logging.CRITICAL)  # what is wrong in the file is told below, once
    try:
        with _without_echo(), opened(file, RECORD.most_bytes) as data:
            tracks = [
                (channel, time)
                for channel, time in reader(data, file)
                if len(time) > 1 and np.isfinite(channel.values).all() and np.all(np.diff(time) > 0.0)
            ]
    except UnreadableError as error:
        raise ModelError([Problem(file.name, "", f"a file of {title}", error.reason)], str(file)) from None
    except ModelError:
        raise
    except Exception as error:  # what these packages raise of broken files is of any kind
        # Without the name that a package gives a file that is open already.
        reason = " ".join(re.sub(r"^Error opening <[^>]*>: ", "", str(error)).split())[:120] or type(error).__name__
        raise ModelError([Problem(file.name, "", f"a file of {title} that is whole", reason)], str(file)) from None
    if not tracks:
        raise ModelError(
            [Problem(file.name, "", f"channels of finite numbers over a time that rises, in {title}")], str(file)
        )
    return tracks


@contextmanager
def _without_echo() -> Iterator[None]:
    """Objects that a broken file left half-made go away in it, without what they print of that."""
    hook = sys.unraisablehook
    sys.unraisablehook = lambda _: None
    try:
        yield
    except Exception as error:
        traceback.clear_frames(error.__traceback__)
        gc.collect()
        raise
    finally:
        sys.unraisablehook = hook


def _require_size(numbers: int, file: Path) -> None:
    if numbers > MOST_SAMPLES:
        problem = Problem(
            file.name, f"{numbers:,} numbers", f"up to {MOST_SAMPLES:,}: cut it in parts, or sample it down"
        )
        raise ModelError([problem], str(file))


def _of_mdf(data: IO[bytes], file: Path) -> Iterator[Track]:
    """The channels of an MDF4, each with its time."""
    _require_bounded_blocks(data.read(), file)
    data.seek(0)
    from asammdf import MDF

    with MDF(data, process_bus_logging=False) as mdf:
        _require_size(sum(group.channel_group.cycles_nr * len(group.channels) for group in mdf.groups), file)
        for number, group in enumerate(mdf.groups):
            for index, channel in enumerate(group.channels):
                if getattr(channel, "channel_type", 0) in _TIMES or channel.name.lower() == "t":
                    continue
                signal = mdf.get(group=number, index=index, raw=True)
                values = np.asarray(signal.samples)
                conversion = signal.conversion
                kind = _NO_CONVERSION if conversion is None else conversion.conversion_type
                if values.ndim != 1 or values.dtype.kind not in "iuf" or kind not in (_NO_CONVERSION, _LINEAR):
                    continue
                plain = values.astype(float)
                if kind == _LINEAR:
                    plain = conversion.a * plain + conversion.b
                yield Channel(signal.name, signal.unit or "", plain), np.asarray(signal.timestamps, dtype=float)


def _require_bounded_blocks(data: bytes, file: Path) -> None:
    """Refuse packed blocks that unpack to more than they say, or to more than a record may hold."""
    if data[:3] != b"MDF" or data[8:9] != b"4":
        raise ModelError([Problem(file.name, "", "a file of MDF version 4, which begins with its name")], str(file))
    whole = 0
    for found in re.finditer(b"##DZ", data):
        if len(data) < found.start() + _PACKED.size:
            break
        _, _, _, _, how, _, _, before, packed = _PACKED.unpack_from(data, found.start())
        begin = found.start() + _PACKED.size
        whole += before
        if how not in _DEFLATE or whole > 8 * MOST_SAMPLES:
            expected = f"blocks packed by deflate, that unpack to {8 * MOST_SAMPLES:,} bytes at most"
            raise ModelError([Problem(file.name, "", expected)], str(file))
        if len(zlib.decompressobj().decompress(data[begin : begin + packed], before + 1)) != before:
            raise ModelError([Problem(file.name, "", "packed blocks that hold what they say")], str(file))


def _of_tdms(data: IO[bytes], file: Path) -> Iterator[Track]:
    """The channels of a TDMS whose properties tell their times, or whose group has a channel of them."""
    from nptdms import TdmsFile
    from nptdms.log import log_manager

    log_manager.set_level(logging.CRITICAL)
    with TdmsFile.open(data) as tdms:
        if tdms.file_status.incomplete_final_segment:
            raise ModelError([Problem(file.name, "", "a file of TDMS that is whole", _BREAKS_OFF)], str(file))
        channels = [channel for group in tdms.groups() for channel in group.channels()]
        _require_size(sum(len(channel) for channel in channels), file)
        several = len({group.name for group in tdms.groups()}) > 1
        for channel in channels:
            time = _time_of(channel, tdms)
            values = channel[:]
            if time is None or time[0] == channel.name or values.dtype.kind not in "iuf" or len(values) != len(time[1]):
                continue
            name = f"{channel.group_name}/{channel.name}" if several else channel.name
            unit = str(channel.properties.get("unit_string", ""))
            yield Channel(name, unit, values.astype(float)), time[1]


def _time_of(channel: Any, tdms: Any) -> tuple[str, NDArray[np.float64]] | None:
    """Name and values of the time of a channel; the name is "" where its properties tell it."""
    if "wf_increment" in channel.properties:
        # Without an offset, as some loggers leave it out, the first value is that of the start.
        offset = float(channel.properties.get("wf_start_offset", 0.0))
        return "", offset + float(channel.properties["wf_increment"]) * np.arange(len(channel), dtype=np.float64)
    for other in tdms[channel.group_name].channels():
        if other.name.lower() in ("time", "t", "time_s", "time (s)", "time [s]") and len(other) == len(channel):
            return str(other.name), np.asarray(other[:], dtype=float)
    return None


def _of_wav(data: IO[bytes], file: Path) -> Iterator[Track]:
    """The channels of a WAV, called by their number; their values are shares of full scale, without a unit."""
    import soundfile

    head = data.read(8)
    end = data.seek(0, os.SEEK_END)
    data.seek(0)
    said = int.from_bytes(head[4:8], "little")
    # A logger that streams leaves the size open.
    if head[:4] == b"RIFF" and end < said + 8 and said != _OPEN:
        raise ModelError([Problem(file.name, "", "a file of WAV that is whole", _BREAKS_OFF)], str(file))
    with soundfile.SoundFile(data) as sound:
        _require_size(sound.frames * sound.channels, file)
        rate = sound.samplerate
        table = sound.read(dtype="float64", always_2d=True)
    time = np.arange(len(table)) / rate
    for number, values in enumerate(table.T, 1):
        yield Channel(str(number), "", values.copy()), time


if __name__ == "__main__":
    _write_apart(sys.argv[1])
