"""What takes runs, piece by piece: values that the same sources have computed before are read, not computed again.

Each system has PIECES, functions without arguments by name that return values by key. A run that was interrupted goes on with the
first piece that is missing. Values are kept in validation/seeds/.kept/ by a digest of the package, of these scripts and of the
models: after any change to them all are computed anew.

    python -m validation.seeds.kept marine          the values of one system, and the CPU seconds of each piece
    python -m validation.seeds.kept marine.film     those of one piece
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import time
from collections.abc import Callable, Mapping
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
FOLDER = Path(__file__).resolve().parent / ".kept"
_SOURCES = (
    "rotorgear/**/*.py",
    "validation/seeds/*.py",
    "validation/cases/split_torque_lines/*.py",
    "models/*.toml",
    "models/*.csv",
)

Pieces = Mapping[str, Callable[[], Mapping[str, Any]]]


@cache
def digest() -> str:
    """Of all that the values follow from."""
    found = hashlib.sha256()
    for pattern in _SOURCES:
        for file in sorted(ROOT.glob(pattern)):
            found.update(str(file.relative_to(ROOT)).encode())
            found.update(file.read_bytes())
    return found.hexdigest()[:16]


def piece(system: str, name: str, pieces: Pieces) -> dict[str, Any]:
    """The values of a piece, with its "CPU seconds"."""
    file = FOLDER / digest() / f"{system}.{name}.json"
    if not file.exists():
        begun = time.process_time()
        values = dict(pieces[name]())
        file.parent.mkdir(parents=True, exist_ok=True)
        unfinished = file.with_suffix(f".{os.getpid()}")
        text = json.dumps({"values": values, "cpu_s": time.process_time() - begun})
        unfinished.write_text(text, encoding="utf-8")
        unfinished.replace(file)
    return dict(json.loads(file.read_text(encoding="utf-8")))


def values(system: str, pieces: Pieces) -> dict[str, Any]:
    """The values of all pieces of a system."""
    found: dict[str, Any] = {}
    for name in pieces:
        found |= piece(system, name, pieces)["values"]
    return found


def main() -> None:
    """Compute what is named, or all that is missing, and print it."""
    from validation.seeds.rows import SYSTEMS

    parser = argparse.ArgumentParser(
        prog="python -m validation.seeds.kept", description="Values of the five systems, computed once."
    )
    parser.add_argument("names", nargs="*", metavar="NAME[.PIECE]", help=f"of {', '.join(SYSTEMS)}")
    for text in parser.parse_args().names or SYSTEMS:
        system, _, only = text.partition(".")
        pieces = import_module(f"validation.seeds.{system}").PIECES
        for name in [only] if only else pieces:
            found = piece(system, name, pieces)
            print(f"{system}.{name}: {found['cpu_s']:.0f} CPU s", flush=True)
            for key, value in found["values"].items():
                print(f"  {key}: {value}", flush=True)


if __name__ == "__main__":
    main()
