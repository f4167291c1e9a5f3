"""Runs mutants in worker processes: a traceback, a number that is none, a crash, or more than the time limit is a finding."""

from __future__ import annotations

import argparse
import collections
import contextlib
import io
import json
import math
import multiprocessing
import resource
import signal
import sys
import tempfile
import time
import tomllib
import traceback
import warnings
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from rotorgear.errors import RotorgearError
from tests.fuzz.mutate import model_mutations, option_mutations, rig_mutations
from tests.fuzz.verbs import ALL, QUICK, Verb, drawn, not_finite
from tests.fuzz.write_toml import toml_text
from tests.paths import ROOT

TIME_LIMIT = 60.0
_MEMORY = 8 * 2**30
_KINDS = ("model", "options", "rig")
MODELS = sorted((ROOT / "models").glob("*.toml"))
_SMALL = [
    path
    for path in MODELS
    if path.stem in ("jeffcott", "torsion_chain", "helical_pair", "geared_pair", "backlash_pair")
]


@dataclass(frozen=True)
class Finding:
    """What went wrong with one seed: `what` groups findings of one cause."""

    seed: int
    kind: str
    verb: str
    what: str
    details: str


class OutOfTimeError(BaseException):
    """The seed took more CPU time than the limit; no `except Exception` swallows it."""


@contextlib.contextmanager
def _limited(seconds: float) -> Iterator[None]:
    def stop(*_: object) -> None:
        raise OutOfTimeError

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)


def kind_of(seed: int) -> str:
    """Eight in ten mutate a model, one options, one a list of rig lines."""
    return {8: "options", 9: "rig"}.get(seed % 10, "model")


def run_seed(
    seed: int, verbs: dict[str, Verb], folder: Path, limit: float = TIME_LIMIT
) -> tuple[list[Finding], collections.Counter]:
    """Findings of one seed, and how its runs ended: result, refused or found."""
    kind = kind_of(seed)
    ends: collections.Counter = collections.Counter()
    findings: list[Finding] = []
    for verb, act in _acts(kind, seed, verbs, folder):
        try:
            with _limited(limit), warnings.catch_warnings():
                warnings.simplefilter("ignore")
                result = act()
            bad = not_finite(verb, result)
            ends["result" if not bad else "found"] += 1
            if bad:
                findings.append(Finding(seed, kind, verb, f"not finite: {bad}", ""))
        except RotorgearError as error:
            ends["refused"] += 1
            if not str(error).strip():
                findings.append(Finding(seed, kind, verb, "refused without a word", ""))
            if verb == "load":
                break
        except OutOfTimeError:
            ends["found"] += 1
            findings.append(Finding(seed, kind, verb, f"more than {limit:g} CPU s", ""))
        except Exception as error:
            ends["found"] += 1
            last = traceback.extract_tb(error.__traceback__)[-1]
            own = [frame for frame in traceback.extract_tb(error.__traceback__) if "/rotorgear/" in frame.filename]
            place = f"{Path(own[-1].filename).name}:{own[-1].lineno}" if own else f"{last.filename}:{last.lineno}"
            findings.append(Finding(seed, kind, verb, f"{type(error).__name__} in {place}", str(error)[:300]))
            if verb == "load":
                break
    return findings, ends


def mutant(seed: int, name: str = "") -> tuple[str, str]:
    """The model that a seed begins with (or the one of this name), and the text of its mutant."""
    origin = ROOT / "models" / f"{name}.toml" if name else MODELS[seed % 997 % len(MODELS)]
    return origin.stem, toml_text(model_mutations(tomllib.loads(origin.read_text(encoding="utf-8")), seed))


def _acts(kind: str, seed: int, verbs: dict[str, Verb], folder: Path) -> Iterator[tuple[str, Any]]:
    import rotorgear as rg

    if kind == "model":
        path = folder / "mutant.toml"
        path.write_text(mutant(seed)[1], encoding="utf-8", errors="surrogatepass")
        found: list[rg.Model] = []
        yield "load", lambda: found.append(rg.load(path))
        if found:
            for verb, act in verbs.items():
                yield verb, lambda act=act: act(found[0])
    elif kind == "rig":
        path = folder / "rig.csv"
        path.write_bytes(rig_mutations((ROOT / "models" / "split_torque_rig.csv").read_text(encoding="utf-8"), seed))
        yield "rig", lambda: rg.read_rig_lines(path)
    else:
        command, *options = option_mutations(seed)
        model = _SMALL[seed // 10 % len(_SMALL)]
        yield " ".join([command, model.stem, *options]), lambda: _command([command, str(model), *options])


def _command(arguments: list[str]) -> None:
    """Run the command line in this process; what typer refuses is as good as a sentence."""
    from rotorgear.cli.main import app

    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()) as said:
        try:
            app(arguments)
        except SystemExit as end:
            if end.code not in (0, 2):
                raise AssertionError(f"exit code {end.code}: {said.getvalue()}") from None


def chosen(verbs: str, seed: int) -> dict[str, Verb]:
    """The verbs of a seed: all, the quick ones, or the quick ones and one that is drawn."""
    return drawn(seed) if verbs == "drawn" else ALL if verbs == "all" else QUICK


def _work(pipe: Connection, verbs: str, limit: float) -> None:
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    with tempfile.TemporaryDirectory() as folder:
        while (seed := pipe.recv()) is not None:
            start = time.process_time()
            findings, ends = run_seed(seed, chosen(verbs, seed), Path(folder), limit)
            pipe.send((seed, findings, ends, time.process_time() - start))


def main() -> int:
    """Run the command; 1 where there is any finding."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    parser.add_argument("--files", type=int, default=100, help="number of mutants (default 100)")
    parser.add_argument("--seed", type=int, default=0, help="the first seed; each mutant has its own (default 0)")
    parser.add_argument(
        "--limit", type=float, default=TIME_LIMIT, help="CPU seconds of one verb on one file (default 60)"
    )
    parser.add_argument(
        "--seconds",
        type=float,
        default=math.inf,
        help="begin no more files after this time (default: all are gone through)",
    )
    parser.add_argument("--jobs", type=int, default=1, help="worker processes (default 1)")
    parser.add_argument(
        "--verbs",
        choices=["all", "drawn", "quick"],
        default="all",
        help="quick: check, modes, statics and gear sheets only; drawn: these and one more, slow ones rarely",
    )
    parser.add_argument("--report", type=Path, help="write the findings to this file, as JSON lines")
    parser.add_argument("--show", type=int, metavar="SEED", help="print the mutant of a seed and stop")
    asked = parser.parse_args()
    if asked.show is not None:
        text = mutant(asked.show)[1] if kind_of(asked.show) == "model" else " ".join(option_mutations(asked.show))
        sys.stdout.write(text + "\n")
        return 0
    done, findings, ends, slowest = run(asked)
    groups = collections.Counter((found.verb.split(" ")[0], found.what) for found in findings)
    for (verb, what), count in groups.most_common():
        first = next(found for found in findings if (found.verb.split(" ")[0], found.what) == (verb, what))
        print(f"{count:4} x {verb}: {what} (seed {first.seed}, {first.verb}): {first.details[:160]}")
    total = ", ".join(f"{count} {name}" for name, count in sorted(ends.items()))
    print(
        f"{done} files from seed {asked.seed}: {total}; {len(findings)} findings; "
        f"slowest file {slowest[0]:.1f} CPU s (seed {slowest[1]})"
    )
    return 1 if findings else 0


def run(asked: argparse.Namespace) -> tuple[int, list[Finding], collections.Counter, tuple[float, int]]:
    """Number of seeds gone through, findings, how the runs ended, and the slowest seed; a worker that dies is replaced."""
    last = time.monotonic() + asked.seconds
    context = multiprocessing.get_context("spawn")
    waiting = collections.deque(range(asked.seed, asked.seed + asked.files))
    findings: list[Finding] = []
    ends: collections.Counter = collections.Counter()
    slowest = (0.0, -1)
    workers: dict[Connection, tuple[Any, int]] = {}
    report = asked.report.open("a", encoding="utf-8") if asked.report else None

    def begin() -> None:
        ours, theirs = context.Pipe()
        process = context.Process(target=_work, args=(theirs, asked.verbs, asked.limit), daemon=True)
        process.start()
        theirs.close()
        give(ours, process)

    def give(pipe: Connection, process: Any) -> None:
        seed = waiting.popleft() if waiting and time.monotonic() < last else None
        pipe.send(seed)
        if seed is None:
            workers.pop(pipe, None)
            process.join()
        else:
            workers[pipe] = (process, seed)

    for _ in range(min(asked.jobs, asked.files)):
        begin()
    done = 0
    while workers:
        for pipe in multiprocessing.connection.wait(list(workers)):
            process, seed = workers[pipe]
            try:
                _, found, how, spent = pipe.recv()
            except EOFError:
                process.join()
                del workers[pipe]
                found, how, spent = (
                    [Finding(seed, kind_of(seed), "?", f"crash, exit code {process.exitcode}", "")],
                    {"found": 1},
                    0.0,
                )
                if waiting and time.monotonic() < last:
                    begin()
            else:
                give(pipe, process)
            done += 1
            findings += found
            ends.update(how)
            slowest = max(slowest, (spent, seed))
            for item in found:
                if report:
                    report.write(json.dumps(asdict(item)) + "\n")
                    report.flush()
            if sys.stderr.isatty():
                sys.stderr.write(f"\r{done} of {asked.files} files, {len(findings)} findings")
    return done, findings, ends, slowest
