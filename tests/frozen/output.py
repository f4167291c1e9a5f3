"""What one run says, key by key, as plain values that two versions can be compared by."""

from __future__ import annotations

import signal
import time
import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np

from rotorgear.errors import RotorgearError
from tests.frozen.runs import Case, cases

# A case is given up after so many CPU seconds, and says nothing then.
LONGEST = 40.0
UNFINISHED = "unfinished after CPU s"
_LEFT_OUT = ("seconds", "seconds_by_step", "memory_bytes", "rotorgear_version", "version", "cpu_seconds")


def said(case: Case) -> dict[str, Any]:
    """What one run says, key by key: its JSON output, or its refusal."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            result = case.run(case.model())
        except (RotorgearError, ValueError, TypeError) as error:
            return {"refused": f"{type(error).__name__}: {error}"}
    parts = result if isinstance(result, list) else [result]
    return dict(_flat([part.to_dict() if hasattr(part, "to_dict") else part for part in parts], ""))


def _flat(value: Any, key: str) -> Iterator[tuple[str, Any]]:
    """Every leaf with its key; lists of numbers are one leaf."""
    if isinstance(value, dict):
        for name, entry in value.items():
            if name not in _LEFT_OUT:
                yield from _flat(entry, f"{key}.{name}")
    elif isinstance(value, list | tuple):
        numbers = np.asarray(value, dtype=object).ravel()
        if len(numbers) and all(isinstance(x, int | float | bool | None) for x in numbers):
            yield key, np.array([np.nan if x is None else float(x) for x in numbers])
        else:
            for i, entry in enumerate(value):
                yield from _flat(entry, f"{key}[{i}]")
    else:
        yield key, value


def run_case(number: int) -> tuple[str, dict[str, Any], float]:
    """Name, output and CPU seconds of one case by its number."""
    case = cases()[number]
    start = time.process_time()
    signal.signal(signal.SIGPROF, _ended)
    signal.setitimer(signal.ITIMER_PROF, LONGEST)
    try:
        found = said(case)
    except TimeoutError:
        found = {UNFINISHED: LONGEST}
    except Exception as error:  # a fault of the program is an output as well, and the others must be written
        found = {"traceback": f"{type(error).__name__}: {error}"}
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
    return case.name, found, time.process_time() - start


def _ended(signum: int, frame: object) -> None:
    raise TimeoutError
