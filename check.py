"""The one command that runs what CI runs:  python3 check.py

It keeps a virtual environment of its own (`.venv-check`, or the directory named by ROTORGEAR_VENV) with the project and its
test tools, and runs in it, on one thread each: ruff format, ruff check, mypy, and all tests, those of the docs among them, on two
cores. With --oldest it runs the quick tests in a second environment, with the oldest version of every dependency.
Needs Python 3.11 with venv, no more.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import re
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent
OLDEST_PYTHON = (3, 11)
STAMP = "rotorgear-check.stamp"
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}


class SetupError(Exception):
    """The environment can't be made; the text says why and what to do."""


@dataclass(frozen=True)
class Step:
    """One check: its name, and what the environment's Python is started with, without and with --fix."""

    name: str
    run: tuple[str, ...]
    fix: tuple[str, ...] = ()


PYTEST = ("-m", "pytest")
FORMAT = Step("format", ("-m", "ruff", "format", "--check", "."), ("-m", "ruff", "format", "."))
LINT = Step("lint", ("-m", "ruff", "check", "."), ("-m", "ruff", "check", "--fix", "."))
TYPES = Step("types", ("-m", "mypy"))
DOCS = Step("docs", (*PYTEST, "tests/docs"))
# Tests of a file mostly stay together, for they share models and compiled code; a worker without work takes half of another's.
TESTS = Step("tests", (*PYTEST, "tests", "-n", "2", "--dist", "worksteal"))
FAST_TESTS = Step("tests", (*PYTEST, "tests/unit", "tests/contract"))
# On their own: they want an index of packages, or a browser. All models on every leaf take minutes, with the long tests.
WHEEL = Step("wheel", (*PYTEST, "tests/installed", "-m", "long"))
BROWSER = Step("browser", (*PYTEST, "tests/browser", "-m", "long", "-k", "not every_leaf"))
SITE = Step("site", ("docs/build_site.py",))
LONG_TESTS = Step("long", (*PYTEST, "tests", "-m", "long"))

USUAL = (FORMAT, LINT, TYPES, TESTS)
FAST = (FORMAT, LINT, TYPES, FAST_TESTS)
# With the oldest versions of all dependencies that pyproject.toml allows, in an environment of its own.
OLDEST_TESTS = Step("oldest", (*PYTEST, "tests/unit", "tests/contract", "-n", "2", "--dist", "loadfile"))


def main(arguments: list[str] | None = None) -> int:
    """Run the checks that were asked for; return the exit code: 0 all passed, 1 a check failed, 2 no environment."""
    options = parse_arguments(arguments)
    if sys.version_info[:2] < OLDEST_PYTHON:
        print(f"check.py: this is Python {sys.version.split()[0]}; start it with Python 3.11 or newer", file=sys.stderr)
        return 2
    venv = Path(os.environ.get("ROTORGEAR_VENV") or ROOT / ".venv-check").absolute()
    if options.oldest:
        venv = venv.with_name(f"{venv.name}-oldest")
    try:
        prepare(venv, oldest=options.oldest)
    except SetupError as error:
        print(f"check.py: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"check.py: can't write the environment {venv}: {error.strerror or error}", file=sys.stderr)
        return 2
    return run_steps(chosen(options), venv, options.fix, options.keep_going)


def parse_arguments(arguments: list[str] | None) -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(prog="check.py", description="Run what CI runs: format, lint, types, docs, tests.")
    names = [step.name for step in (*USUAL, DOCS, SITE, WHEEL, BROWSER, LONG_TESTS)]
    which = parser.add_mutually_exclusive_group()
    which.add_argument(
        "--only", metavar="NAME", choices=names, action="append", help=f"one check of: {', '.join(names)}"
    )
    which.add_argument("--fast", action="store_true", help="leave out the docs and the convergence tests")
    which.add_argument(
        "--oldest",
        action="store_true",
        help="only the quick tests, with the oldest versions that pyproject.toml allows",
    )
    parser.add_argument("--long", action="store_true", help="run the long validations too, after all else")
    parser.add_argument("--fix", action="store_true", help="mend format and lint instead of only complaining")
    parser.add_argument("--keep-going", action="store_true", help="run all checks even when one fails")
    return parser.parse_args(arguments)


def chosen(options: argparse.Namespace) -> tuple[Step, ...]:
    """Return the steps to run, in order."""
    if options.oldest:
        return (OLDEST_TESTS,)
    if options.only:
        steps = tuple(step for step in (*USUAL, DOCS, SITE, WHEEL, BROWSER, LONG_TESTS) if step.name in options.only)
    else:
        steps = FAST if options.fast else USUAL
    return (*steps, LONG_TESTS) if options.long and LONG_TESTS not in steps else steps


def python_of(venv: Path, windows: bool = os.name == "nt") -> Path:
    """Return the interpreter of a virtual environment."""
    return venv / "Scripts" / "python.exe" if windows else venv / "bin" / "python"


def fingerprint() -> str:
    """Say in one line what an environment is made from: this Python, this clone and its pyproject.toml."""
    digest = hashlib.sha256((ROOT / "pyproject.toml").read_bytes()).hexdigest()
    return f"{sys.version.split()[0]} {ROOT} {digest}"


def is_current(venv: Path) -> bool:
    """Whether the environment stands and was completed from the same Python, clone and pyproject.toml."""
    stamp = venv / STAMP
    return python_of(venv).exists() and stamp.exists() and stamp.read_text(encoding="utf-8") == fingerprint()


def oldest_versions() -> list[str]:
    """The lower bound of every dependency in pyproject.toml, those of the extras too, as requirements such as numpy==1.26."""
    import tomllib  # here, so that an older Python gets as far as to be told that it is too old

    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    found = set()
    for text in [
        *project["dependencies"],
        *(text for group in project["optional-dependencies"].values() for text in group),
    ]:
        requirement, _, marker = text.partition(";")
        match = re.match(r"(?P<name>[A-Za-z0-9_.-]+)\s*>=\s*(?P<least>[0-9.]+)", requirement)
        if match:
            found.add(f"{match['name']}=={match['least']}" + (f"; {marker.strip()}" if marker else ""))
    return sorted(found)


def prepare(venv: Path, oldest: bool = False) -> None:
    """Make the environment, or bring it up to date; the stamp is written last, so a broken attempt is repeated."""
    if is_current(venv):
        return
    if venv.exists() and not (venv / "pyvenv.cfg").exists() and (not venv.is_dir() or any(venv.iterdir())):
        raise SetupError(f"{venv} exists and is no virtual environment: name another directory in ROTORGEAR_VENV")
    stamp = venv / STAMP
    same_python = stamp.exists() and stamp.read_text(encoding="utf-8").split()[0] == sys.version.split()[0]
    stamp.unlink(missing_ok=True)
    say(f"preparing {venv}")
    if not (same_python and python_of(venv).exists()):
        if venv.exists():
            shutil.rmtree(venv)
        command = [sys.executable, "-m", "venv", str(venv)]
        if subprocess.run(command, check=False).returncode != 0:
            raise SetupError(
                "this Python can't make a virtual environment; on Debian or Ubuntu: apt install python3-venv"
            )
    install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--editable", ".[test]"]
    if oldest:
        install += oldest_versions()
    if subprocess.run([str(python_of(venv)), *install], check=False, cwd=ROOT).returncode != 0:
        raise SetupError(
            "pip could not install rotorgear and its test tools (its reason stands above); "
            "check the network or the package index, then run this again"
        )
    unfinished = stamp.with_suffix(".new")
    unfinished.write_text(fingerprint(), encoding="utf-8")
    os.replace(unfinished, stamp)


def run_steps(steps: tuple[Step, ...], venv: Path, fix: bool, keep_going: bool) -> int:
    """Run the steps, print a line for each; return 1 if one failed."""
    environment = {**os.environ, **ONE_THREAD}
    environment.pop("PYTHONPATH", None)
    lines: list[str] = []
    failed = False
    for step in steps:
        if failed and not keep_going:
            lines.append(f"{step.name:8s} not run")
            continue
        arguments = step.fix if fix and step.fix else step.run
        say(f"{step.name}: {' '.join(arguments[1:])}")
        start = time.perf_counter()
        code = subprocess.run([str(python_of(venv)), *arguments], cwd=ROOT, env=environment, check=False).returncode
        lines.append(f"{step.name:8s} {'passed' if code == 0 else 'FAILED'} {time.perf_counter() - start:8.1f} s")
        failed |= code != 0
    say("summary")
    print("\n".join(lines), flush=True)
    return int(failed)


def say(text: str) -> None:
    """Print a heading, before the output of what it announces."""
    print(f"== {text}", flush=True)


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
