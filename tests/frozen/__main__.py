"""Write what all verbs say, or tell two such files apart, number for number:

    python -m tests.frozen write before.pickle [--only TEXT ...] [--jobs 2]
    python -m tests.frozen compare before.pickle after.pickle

Digits are those of one machine: write both files on it, with one thread (OPENBLAS_NUM_THREADS=1). Times and versions are left
out, and a refusal counts as its sentence. A file that is there is gone on with. The exit code of `compare` is 1 where anything
differs.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import pickle
import sys
from collections.abc import Iterator
from typing import Any

import numpy as np

from tests.frozen.output import UNFINISHED, run_case
from tests.frozen.runs import cases


def write(path: str, only: list[str], jobs: int) -> None:
    """Run all cases whose name has one of the texts and write what they say."""
    found: dict[str, dict[str, Any]] = {}
    if os.path.exists(path):
        with open(path, "rb") as file:
            found = pickle.load(file)
    wanted = [k for k, case in enumerate(cases()) if not only or any(text in case.name for text in only)]
    chosen = [k for k in wanted if cases()[k].name not in found]
    with multiprocessing.get_context("spawn").Pool(jobs, maxtasksperchild=40) as pool:
        for name, output, seconds in pool.imap_unordered(run_case, chosen):
            found[name] = output
            print(f"{len(found):4d} of {len(wanted)}  {seconds:7.1f} s  {name}", flush=True)
            with open(path, "wb") as file:
                pickle.dump(found, file)


def compare(first: str, second: str) -> int:
    """Print what differs, with the largest change of each list over its largest entry; return how many cases do."""
    with open(first, "rb") as one, open(second, "rb") as other:
        before, after = pickle.load(one), pickle.load(other)
    differing = 0
    both = [name for name in sorted(before.keys() & after.keys()) if UNFINISHED not in {*before[name], *after[name]}]
    for name in both:
        lines = [
            line
            for key in sorted(before[name].keys() | after[name].keys())
            for line in _told(key, before[name], after[name])
        ]
        if lines:
            differing += 1
            print(name, *lines, sep="\n    ")
    alone = sorted(before.keys() ^ after.keys())
    print(f"{len(both)} cases finished in both, {differing} differ; in one file only: {alone or 'none'}")
    return differing


def _told(key: str, before: dict[str, Any], after: dict[str, Any]) -> Iterator[str]:
    a, b = before.get(key), after.get(key)
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray) and a.shape == b.shape:
        if not np.array_equal(a, b, equal_nan=True):
            change = np.nanmax(np.abs(a - b), initial=0.0) / max(float(np.nanmax(np.abs(a), initial=0.0)), 1e-300)
            yield f"{key}: {change:.1e} of its largest"
    elif isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        yield f"{key}: {a} -> {b}"
    elif a != b and not (isinstance(a, float) and isinstance(b, float) and np.isnan(a) and np.isnan(b)):
        yield f"{key}: {a!r} -> {b!r}"


def main() -> int:
    """Read the command line."""
    parser = argparse.ArgumentParser(prog="python -m tests.frozen", description=__doc__.splitlines()[0])
    verbs = parser.add_subparsers(dest="verb", required=True)
    writes = verbs.add_parser("write")
    writes.add_argument("file")
    writes.add_argument("--only", nargs="*", default=[])
    writes.add_argument("--jobs", type=int, default=2)
    compares = verbs.add_parser("compare")
    compares.add_argument("before")
    compares.add_argument("after")
    options = parser.parse_args()
    if options.verb == "write":
        write(options.file, options.only, options.jobs)
        return 0
    return min(compare(options.before, options.after), 1)


if __name__ == "__main__":
    sys.exit(main())
