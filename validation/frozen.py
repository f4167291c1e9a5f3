"""Outputs of all models, kept before a change and compared after it.

    python -m validation.frozen keep FOLDER
    python -m validation.frozen compare FOLDER [--tolerance 1e-10]

Each command of COMMANDS runs for each shipped model with --json. `compare` runs them again, and says every value that moved by
more than the tolerance, relative to the largest value of its array, and every sentence that changed. Seconds are not compared.
A refusal is kept as its sentence: a model that is refused must go on being refused with the same words.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import json
import math
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

MODELS = Path(__file__).resolve().parent.parent / "models"
# Small enough that all models take a few minutes; chaotic motions would amplify rounding and are left out.
COMMANDS: dict[str, tuple[str, ...]] = {
    "check": ("check",),
    "modal": ("modal", "--modes", "24"),
    "modal_at_speed": ("modal", "--modes", "12", "--speed", "3000 rpm"),
    "campbell": ("campbell", "--to", "6000 rpm", "--points", "7", "--modes", "8"),
    "critical": ("critical", "--to", "12000 rpm"),
    "static": ("static",),
    "response": ("response", "--from", "1000 rpm", "--to", "4000 rpm", "--points", "4"),
    "gear": ("gear",),
    "transient": ("transient", "--time", "0.002 s", "--discard", "0.001 s", "--no-error-estimate"),
}
# What differs between two runs of the same program.
NOT_COMPARED = ("seconds",)


def run(arguments: list[str]) -> str:
    """Run one command of the command line in this process; return what a refusal said, or nothing."""
    from rotorgear.cli.main import app
    from rotorgear.errors import RotorgearError

    try:
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            app(arguments, standalone_mode=False)
    except RotorgearError as error:
        return f"{type(error).__name__}: {error}"
    return ""


def outputs(folder: Path) -> Iterator[tuple[str, Any]]:
    """Yield the name and the JSON of every command for every model."""
    for model in sorted(MODELS.glob("*.toml")):
        for name, (command, *options) in COMMANDS.items():
            file = folder / f"{model.stem}.{name}.json"
            file.unlink(missing_ok=True)
            refusal = run([command, str(model), *options, "--json", str(file)])
            if not file.exists():
                file.write_text(json.dumps({"refused": refusal.replace(str(MODELS.parent), "")}), encoding="utf-8")
            yield file.name, json.loads(file.read_text(encoding="utf-8"))


def differences(old: Any, new: Any, tolerance: float, address: str = "") -> Iterator[str]:
    """Yield what differs between two JSON values, with its address."""
    if isinstance(old, dict) and isinstance(new, dict):
        for key in sorted(set(old) | set(new)):
            if any(word in key for word in NOT_COMPARED):
                continue
            if key not in old or key not in new:
                yield f"{address}.{key}: only {'before' if key in old else 'after'}"
            else:
                yield from differences(old[key], new[key], tolerance, f"{address}.{key}")
    elif is_numeric(old) and is_numeric(new) and len(old) == len(new):
        scale = max((abs(x) for x in (*old, *new) if x is not None and math.isfinite(x)), default=0.0)
        for place, (a, b) in enumerate(zip(old, new, strict=True)):
            if (a is None) != (b is None) or (a is not None and abs(a - b) > tolerance * scale):
                yield f"{address}[{place}]: {a} -> {b}"
    elif isinstance(old, list) and isinstance(new, list) and len(old) == len(new):
        for place, (a, b) in enumerate(zip(old, new, strict=True)):
            yield from differences(a, b, tolerance, f"{address}[{place}]")
    elif is_number(old) and is_number(new):
        if abs(old - new) > tolerance * max(abs(old), abs(new)):
            yield f"{address}: {old} -> {new}"
    elif old != new:
        yield f"{address}: {str(old)[:200]!r} -> {str(new)[:200]!r}"


def is_number(value: Any) -> bool:
    """Whether a JSON value is a number; true and false are none."""
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def is_numeric(values: Any) -> bool:
    """Whether a JSON value is a list of numbers and nulls."""
    return isinstance(values, list) and bool(values) and all(x is None or is_number(x) for x in values)


def main() -> int:
    """Keep or compare."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", choices=("keep", "compare"))
    parser.add_argument("folder", type=Path)
    parser.add_argument("--tolerance", type=float, default=1e-10)
    parser.add_argument("--most", type=int, default=8, help="differences listed for each output")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    if options.what == "keep":
        print(f"kept {sum(1 for _ in outputs(options.folder))} outputs in {options.folder}")
        return 0
    again = options.folder / "again"
    again.mkdir(exist_ok=True)
    moved = 0
    for name, new in outputs(again):
        kept = options.folder / name
        old = json.loads(kept.read_text(encoding="utf-8")) if kept.exists() else {"refused": "was not run"}
        found = list(differences(old, new, options.tolerance))
        moved += bool(found)
        for line in found[: options.most]:
            print(f"{name}{line}")
        if len(found) > options.most:
            print(f"{name}: {len(found) - options.most} more")
    print(f"{moved} outputs moved")
    return int(moved > 0)


if __name__ == "__main__":
    sys.exit(main())
