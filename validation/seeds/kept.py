"""What takes runs, piece by piece, and what came out.

A module of a system has PIECES: functions without arguments by name that return values by key. Their values stand beside it in
NAME.json, each piece with the commit at which it ran and its CPU seconds (null: taken from the page of that commit); the rows are
judged from them without a run.

    python -m validation.seeds.kept marine            run all pieces of a module
    python -m validation.seeds.kept marine --missing  those that its file has not
    python -m validation.seeds.kept marine.film       run one piece
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import subprocess
import time
from collections.abc import Callable, Mapping
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
BESIDE = Path(__file__).resolve().parent
FOLDER = BESIDE / ".kept"
_SOURCES = (
    "rotorgear/**/*.py",
    "validation/seeds/*.py",
    "validation/cases/split_torque_lines/*.py",
    "models/*.toml",
    "models/*.csv",
)

Pieces = Mapping[str, Callable[[], Mapping[str, Any]]]


def stored(module: str) -> dict[str, dict[str, Any]]:
    """The pieces of NAME.json, each with its "values", "cpu_s" and "commit"; none where there is no such file."""
    file = BESIDE / f"{module}.json"
    return dict(json.loads(file.read_text(encoding="utf-8"))) if file.exists() else {}


def values(module: str) -> dict[str, Any]:
    """The values of all pieces of NAME.json by their key."""
    return {key: value for piece in stored(module).values() for key, value in piece["values"].items()}


def run(module: str, names: list[str], pieces: Pieces) -> None:
    """Run pieces and write each to NAME.json when it is done; pieces that the module has no longer go."""
    for name in names:
        begun = time.process_time()
        found = dict(pieces[name]())
        spent = time.process_time() - begun
        kept = stored(module)
        kept[name] = {"commit": _commit(), "cpu_s": round(spent, 1), "values": found}
        in_order = {one: kept[one] for one in pieces if one in kept}
        file = BESIDE / f"{module}.json"
        unfinished = file.with_suffix(f".{os.getpid()}")
        unfinished.write_text(json.dumps(in_order, indent=1, ensure_ascii=False) + "\n", encoding="utf-8", newline="\n")
        unfinished.replace(file)
        print(f"{module}.{name}: {spent:.0f} CPU s", flush=True)
        for key, value in found.items():
            print(f"  {key}: {value}", flush=True)


@cache
def _commit() -> str:
    words = ["git", "-C", str(ROOT), "rev-parse", "--short=8", "HEAD"]
    return subprocess.run(words, capture_output=True, check=False, text=True).stdout.strip() or "-"


@cache
def digest() -> str:
    """Of the package, of these scripts and of the models."""
    found = hashlib.sha256()
    for pattern in _SOURCES:
        for file in sorted(ROOT.glob(pattern)):
            found.update(str(file.relative_to(ROOT)).encode())
            found.update(file.read_bytes())
    return found.hexdigest()[:16]


def piece(system: str, name: str, pieces: Pieces) -> dict[str, Any]:
    """A piece in validation/seeds/.kept/ by the digest of all sources, which a comparison of runs reads again."""
    file = FOLDER / digest() / f"{system}.{name}.json"
    if not file.exists():
        begun = time.process_time()
        found = dict(pieces[name]())
        file.parent.mkdir(parents=True, exist_ok=True)
        unfinished = file.with_suffix(f".{os.getpid()}")
        text = json.dumps({"values": found, "cpu_s": time.process_time() - begun})
        unfinished.write_text(text, encoding="utf-8")
        unfinished.replace(file)
    return dict(json.loads(file.read_text(encoding="utf-8")))


def main() -> None:
    """Run what is named and keep what comes out."""
    parser = argparse.ArgumentParser(
        prog="python -m validation.seeds.kept", description="Run what the five systems are judged by."
    )
    parser.add_argument("names", nargs="+", metavar="MODULE[.PIECE]", help="marine, marine.film")
    parser.add_argument("--missing", action="store_true", help="only pieces that have no values yet")
    options = parser.parse_args()
    for text in options.names:
        module, _, only = text.partition(".")
        pieces = import_module(f"validation.seeds.{module}").PIECES
        known = stored(module) if options.missing else {}
        run(module, [name for name in ([only] if only else pieces) if name not in known], pieces)


if __name__ == "__main__":
    main()
