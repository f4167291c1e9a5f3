"""Put one-line faults into a copy of the package, one at a time, and see whether the tests that are named for it fail.

    killed           a named test fails
    survived         all of them pass: the tests do not see the fault
    does not apply   the text to change is not there exactly once: the list has to follow the code
    not done         no test had failed at the limit of CPU time
    equivalent       the list says why the change changes nothing; it is not run

The work tree is never touched. Compiled code of the copy is kept in a folder of its own, named by the hash of its sources
(`rotorgear/fingerprint.py`), and byte code is not written at all, so that no run is answered with code of another one.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

if sys.platform == "linux":
    import resource

ROOT = Path(__file__).resolve().parents[2]
LIST = Path(__file__).with_name("mutations.toml")
# What tests read beside the package itself.
COPIED = (
    "rotorgear",
    "tests",
    "models",
    "validation",
    "docs",
    "pyproject.toml",
    "README.md",
    "CHANGELOG.md",
    "check.py",
)
KILLED = "killed"
SURVIVED = "survived"
EQUIVALENT = "equivalent"
NOT_APPLIED = "does not apply"
NO_TEST = "no such test"
NOT_DONE = "not done"
_PASSED = 0
# What Linux ends a process with at its limit of CPU time.
_OUT_OF_TIME = (-24, -9)
# Clock over CPU time after which tests count as hanging.
_WAITING = 20.0
_NO_SUCH_TEST = (4, 5)  # pytest's exit codes for a wrong path, and for nothing that was collected


@dataclass(frozen=True)
class Mutation:
    """One fault.

    Attributes:
        name: a short name.
        file: of the package, below rotorgear/.
        old: text that stands there once.
        new: what it becomes.
        why: what is wrong then.
        tests: paths or ids of tests, one of which has to fail.
        equivalent: why no test can see it; "" where one can.
    """

    name: str
    file: str
    old: str
    new: str
    why: str
    tests: tuple[str, ...] = ()
    equivalent: str = ""


@dataclass(frozen=True)
class Outcome:
    """What became of a mutation, with the last lines of the tests' output and the seconds it took."""

    mutation: Mutation
    status: str
    output: str = ""
    seconds: float = 0.0


def read(path: Path = LIST) -> list[Mutation]:
    """Return the list.

    Raises:
        ValueError: two entries share a name, or one has neither tests nor a reason to have none.
    """
    with path.open("rb") as file:
        entries = tomllib.load(file)["mutation"]
    found = [Mutation(**{**entry, "tests": tuple(entry.get("tests", ()))}) for entry in entries]
    names = [each.name for each in found]
    for each in found:
        if names.count(each.name) > 1:
            raise ValueError(f"{path.name}: two mutations are called {each.name!r}")
        if bool(each.tests) == bool(each.equivalent):
            raise ValueError(f"{path.name}: {each.name!r} needs either tests or a reason why it is equivalent")
    return found


def mutated(text: str, mutation: Mutation) -> str | None:
    """Return the text with the fault in it; None where the old text does not stand there exactly once."""
    return text.replace(mutation.old, mutation.new) if text.count(mutation.old) == 1 else None


def applies(mutation: Mutation, root: Path = ROOT) -> bool:
    """Whether the fault can still be put into the code."""
    path = root / "rotorgear" / mutation.file
    return path.is_file() and mutated(path.read_text(encoding="utf-8"), mutation) is not None


def copy_tree(folder: Path) -> Path:
    """Copy the package and all that its tests read; return the folder of the copy."""
    tree = folder / "tree"
    tree.mkdir()
    for name in COPIED:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, tree / name, ignore=shutil.ignore_patterns("__pycache__", ".*_cache"))
        elif source.is_file():
            shutil.copy2(source, tree / name)
    return tree


@contextmanager
def fault(tree: Path, mutation: Mutation) -> Iterator[bool]:
    """Put a fault into a copy and take it out again; yields whether it could be put there."""
    path = tree / "rotorgear" / mutation.file
    before = path.read_text(encoding="utf-8") if path.is_file() else ""
    after = mutated(before, mutation)
    if after is None:
        yield False
        return
    path.write_text(after, encoding="utf-8")
    try:
        yield True
    finally:
        path.write_text(before, encoding="utf-8")


def run_tests(tree: Path, tests: Sequence[str], limit: float) -> tuple[int | None, str]:
    """Run tests in a copy up to the first failure; return pytest's exit code, None past the limit, and its output.

    The limit counts CPU seconds where the system can (Linux): other work on the machine makes no fault "not done". Tests that
    wait for ever are ended after a multiple of it by the clock.
    """
    cache = tree.parent / "cache"
    environment = {
        **os.environ,
        "PYTHONPATH": str(tree),  # before the package that is installed
        "PYTHONDONTWRITEBYTECODE": "1",  # byte code is told apart by size and second only
        "ROTORGEAR_CACHE": str(cache),
        "NUMBA_CACHE_DIR": str(cache),  # tests set ROTORGEAR_CACHE for themselves
    }
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-q",
        "-x",
        "--no-header",
        "--tb=short",
        "-p",
        "no:cacheprovider",
        *tests,
    ]
    late = None, f"not done in {limit:g} s"
    with subprocess.Popen(
        command, cwd=tree, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    ) as tests_run:
        if sys.platform == "linux":
            resource.prlimit(tests_run.pid, resource.RLIMIT_CPU, (int(limit) + 1, int(limit) + 2))
        try:
            output = tests_run.communicate(timeout=limit * (_WAITING if sys.platform == "linux" else 1.0))[0]
        except subprocess.TimeoutExpired:
            tests_run.kill()
            return late
    return late if tests_run.returncode in _OUT_OF_TIME else (tests_run.returncode, output)


def judge(tree: Path, mutation: Mutation, tests: Sequence[str], limit: float) -> Outcome:
    """Try one mutation in a copy."""
    begin = time.perf_counter()
    with fault(tree, mutation) as put:
        if not put:
            return Outcome(mutation, NOT_APPLIED)
        if mutation.equivalent:
            return Outcome(mutation, EQUIVALENT)
        code, output = run_tests(tree, tests, limit)
    status = {None: NOT_DONE, _PASSED: SURVIVED, **dict.fromkeys(_NO_SUCH_TEST, NO_TEST)}.get(code, KILLED)
    return Outcome(mutation, status, output, time.perf_counter() - begin)


def try_all(
    mutations: Sequence[Mutation],
    limit: float,
    jobs: int = 1,
    tests: Sequence[str] = (),
    tell: Callable[[Outcome], None] = lambda outcome: None,
) -> list[Outcome]:
    """Try mutations, each in one of `jobs` copies; `tests` are run in place of those that the mutations name."""
    with tempfile.TemporaryDirectory(prefix="rotorgear-mutation-") as folder:
        trees = []
        for number in range(max(1, min(jobs, len(mutations)))):
            place = Path(folder) / str(number)
            place.mkdir()
            trees.append(copy_tree(place))

        def share(number: int) -> list[Outcome]:
            found = []
            for mutation in mutations[number :: len(trees)]:
                found.append(judge(trees[number], mutation, tests or mutation.tests, limit))
                tell(found[-1])
            return found

        with ThreadPoolExecutor(len(trees)) as pool:
            shares = list(pool.map(share, range(len(trees))))
    return [shares[i % len(trees)][i // len(trees)] for i in range(len(mutations))]


def sound_tests(mutations: Sequence[Mutation], limit: float) -> tuple[bool, str]:
    """Whether the named tests pass without any fault: if not, they prove nothing."""
    named = sorted({test for mutation in mutations for test in mutation.tests})
    if not named:
        return True, ""
    with tempfile.TemporaryDirectory(prefix="rotorgear-mutation-") as folder:
        code, output = run_tests(copy_tree(Path(folder)), named, limit)
    return code == _PASSED, output


def try_samples(count: int, seed: int, only: Sequence[str], limit: float, jobs: int) -> int:
    """Try so many faults of each package whose name holds one of the texts; print what survives, and the share that is killed."""
    from tests.mutation.sample import drawn, packages  # which imports this file

    equivalent = {(each.file, _with(each)) for each in read() if each.equivalent}
    for package in packages():
        if not any(text in package for text in only):
            continue
        some = [each for each in drawn(package, count, seed) if each.tests]
        tried = [each for each in some if (each.file, _with(each)) not in equivalent]
        outcomes = try_all(tried, limit, jobs)
        killed = sum(each.status == KILLED for each in outcomes)
        told = f", equivalent {len(some) - len(tried)}" if len(some) > len(tried) else ""
        print(f"{package:24} tried {len(outcomes)}, killed {killed}{told}", flush=True)
        for each in outcomes:
            if each.status != KILLED:
                print(f"    {each.status}: {each.mutation.name}\n        {each.mutation.why}", flush=True)
    return 0


def _with(mutation: Mutation) -> str | None:
    """Text of a file of the package with a fault in it."""
    return mutated((ROOT / "rotorgear" / mutation.file).read_text(encoding="utf-8"), mutation)


def main(arguments: Sequence[str] | None = None) -> int:
    """The command; returns 0 where every mutation is killed or equivalent, 1 where not, 2 for a request that makes no sense."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutation", description=__doc__.split("\n")[0])
    parser.add_argument(
        "--list", action="store_true", help="print the list and whether each still applies; run nothing"
    )
    parser.add_argument(
        "--only", action="append", metavar="TEXT", help="those whose name or file holds this; repeatable"
    )
    parser.add_argument("--jobs", type=int, default=1, help="copies that run at the same time (default 1)")
    parser.add_argument(
        "--limit", type=float, default=600.0, help="CPU seconds for the tests of one mutation (default 600)"
    )
    parser.add_argument("--tests", nargs="+", metavar="PATH", help="run these tests in place of the named ones")
    parser.add_argument("--verbose", action="store_true", help="print the end of the tests' output for each mutation")
    parser.add_argument(
        "--sample", type=int, metavar="COUNT", help="so many faults of each package, drawn at random, in place"
    )
    parser.add_argument("--seed", type=int, default=0, help="of the draw (default 0)")
    chosen = parser.parse_args(arguments)
    if chosen.sample:
        return try_samples(chosen.sample, chosen.seed, chosen.only or [""], chosen.limit, chosen.jobs)
    mutations = [
        each
        for each in read()
        if not chosen.only or any(text in each.name or text in each.file for text in chosen.only)
    ]
    if not mutations:
        print("no mutation has such a name or file", file=sys.stderr)
        return 2
    width = max(len(each.name) for each in mutations)
    if chosen.list:
        for each in mutations:
            state = NOT_APPLIED if not applies(each) else EQUIVALENT if each.equivalent else ""
            print(f"{each.name:{width}}  {each.file}  {state}\n    {each.why}")
        return 0 if all(map(applies, mutations)) else 1
    if not chosen.tests:
        sound, output = sound_tests(mutations, 3.0 * chosen.limit)
        if not sound:
            print(
                output[-3000:],
                "the named tests fail without any fault: they prove nothing yet",
                sep="\n",
                file=sys.stderr,
            )
            return 2

    def tell(outcome: Outcome) -> None:
        print(f"{outcome.mutation.name:{width}}  {outcome.status:14}  {outcome.seconds:6.1f} s", flush=True)
        if chosen.verbose or outcome.status == NO_TEST:
            print(outcome.output[-1500:], flush=True)

    outcomes = try_all(mutations, chosen.limit, chosen.jobs, chosen.tests or (), tell)
    counts = {
        status: sum(each.status == status for each in outcomes)
        for status in (KILLED, SURVIVED, EQUIVALENT, NOT_APPLIED, NO_TEST, NOT_DONE)
    }
    print(", ".join(f"{count} {status}" for status, count in counts.items() if count))
    return 0 if counts[KILLED] + counts[EQUIVALENT] == len(outcomes) else 1
