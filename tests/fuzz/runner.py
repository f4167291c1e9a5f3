"""Runs mutants in worker processes: a traceback, a number that is none, a crash, or more than the time limit is a finding."""

from __future__ import annotations

import argparse
import collections
import contextlib
import io
import json
import math
import multiprocessing
import os
import resource
import shutil
import signal
import sys
import tempfile
import time
import tomllib
import traceback
import warnings
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from rotorgear.errors import RotorgearError
from rotorgear.memory import largest_memory
from tests.fuzz.mutate import byte_mutations, model_mutations, option_mutations, rig_mutations
from tests.fuzz.verbs import ALL, LONG, QUICK, Verb, drawn, not_finite
from tests.fuzz.write_toml import toml_text
from tests.paths import ROOT

TIME_LIMIT = 60.0
_MEMORY = 8 * 2**30
_MOST_MEMORY = 4e9
# What is run where no number of files is given, by kind; of "long", every verb of `LONG` so often.
COUNTS = {
    "model": 1400,
    "rig": 100,
    "rexs": 150,
    "mesh": 150,
    "table": 100,
    "universal": 100,
    "options": 600,
    "long": 60,
}
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
    seed: int, verbs: dict[str, Verb], folder: Path, limit: float = TIME_LIMIT, kind: str = ""
) -> tuple[list[Finding], collections.Counter]:
    """Findings of one seed, and how its runs ended: result, refused or found."""
    kind = kind or kind_of(seed)
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
    elif kind == "options":
        command, *options = option_mutations(seed)
        model = _SMALL[seed // 10 % len(_SMALL)]
        yield " ".join([command, model.stem, *options]), lambda: _line(folder, model, command, options)
    elif kind.startswith("long "):
        path = folder / "mutant.toml"
        path.write_text(long_mutant(seed), encoding="utf-8", errors="surrogatepass")
        loaded: list[rg.Model] = []
        yield "load", lambda: loaded.append(rg.load(path))
        if loaded:
            verb = kind.removeprefix("long ")
            yield verb, lambda: LONG[verb](loaded[0])
    else:
        name, data = origin_of(kind, seed)
        path = folder / f"file{Path(name).suffix}"
        path.write_bytes(byte_mutations(data, seed))
        yield f"{kind} {name}", lambda: READERS[kind](path, name)


def long_mutant(seed: int) -> str:
    """A mutant of a small model that is a model, if some of a hundred tries is one: a refusal takes nobody long."""
    import rotorgear as rg

    small = _SMALL[seed % len(_SMALL)].stem
    for number in range(100):
        text = mutant(100 * seed + number, small)[1]
        with contextlib.suppress(RotorgearError, OSError):
            rg.loads(text, folder=ROOT / "models")
            return text
    return mutant(100 * seed, small)[1]


def origin_of(kind: str, seed: int) -> tuple[str, bytes]:
    """Name and contents of the file that a seed mutates."""
    if kind == "table":
        name = list(TABLES)[seed % len(TABLES)]
        return name, TABLES[name].encode()
    origins = [path for pattern in ORIGINS[kind] for path in sorted(ROOT.glob(pattern))]
    origin = origins[seed % len(origins)]
    return origin.name, origin.read_bytes()


# Files of each kind that are mutated, and what reads them.
ORIGINS = {
    "rexs": ("models/*.rexs", "tests/rexs_files/*"),
    "mesh": ("models/elastic_wheel.inp", "models/geared_box.msh"),
    "universal": ("models/*.uff",),
}
_PLACES = range(5)
TABLES = {
    "rig.csv": "frequency_hz;label;uncertainty;damping [%]\n# by hammer\n361,5;first;2 %;1,2\n402;second;3;0,9\n",
    "history.csv": "angle_deg,force_y (kN),moment_x_Nm\n" + "".join(f"{30 * k},{k}.5,{-k}\n" for k in range(12)),
    "flanks.csv": "roll_length_mm,z_mm,deviation_um,tooth,flank\n"
    + "".join(f"{8 + i},{10 * j - 20},{i - j},3,left\n" for i in _PLACES for j in _PLACES),
    "sensors.csv": "point,node,direction\nbearings.left,7,x\ndisks.disk,8,-y\n",
}


def _read_rexs(path: Path, name: str) -> object:
    import rotorgear as rg

    return rg.import_rexs(path)


def _read_mesh(path: Path, name: str) -> object:
    from rotorgear.casings.mesh_file import read_mesh
    from rotorgear.casings.solid_mesh import solid_mesh

    return solid_mesh(read_mesh(path, "casings.b.mesh"), 1e-3, "casings.b.mesh")


def _read_table(path: Path, name: str) -> object:
    import rotorgear as rg
    from rotorgear.analysis.rig.sensor_table import read_sensor_table

    if name == "rig.csv":
        return rg.read_rig_lines(path)
    if name == "sensors.csv":
        return read_sensor_table(path)
    model = "jeffcott" if name == "history.csv" else "helical_pair"
    text = (ROOT / "models" / f"{model}.toml").read_text(encoding="utf-8")
    if name == "history.csv":
        text += f'\n[loads.f]\nshaft = "rotor"\nat = "end"\nhistory = "{path.name}"\n'
    else:
        text = text.replace("[gears.pinion]", f'[gears.pinion]\nflank.topography = "{path.name}"', 1)
    return rg.loads(text, folder=path.parent)


def _read_universal(path: Path, name: str) -> object:
    from rotorgear.uff.read import read_universal

    return read_universal(path)


READERS: dict[str, Callable[[Path, str], object]] = {
    "rexs": _read_rexs,
    "mesh": _read_mesh,
    "table": _read_table,
    "universal": _read_universal,
}


def _line(folder: Path, model: Path, command: str, options: list[str]) -> None:
    """Run a line of options in a folder of its own: nothing half-written is left, and no input is changed."""
    home = Path(tempfile.mkdtemp(dir=folder))
    shutil.copy(model, home / "model.toml")
    shutil.copy(ROOT / "models" / "split_torque_rig.csv", home / "rig.csv")
    shutil.copy(ROOT / "models" / "split_torque_shapes.uff", home / "shapes.uff")
    (home / "old.json").write_text("old")
    (home / "old.json").chmod(0o444)
    (home / "folder").mkdir()
    os.mkfifo(home / "pipe")
    inputs = {path: path.read_bytes() for path in home.iterdir() if path.is_file()}
    before = Path.cwd()
    os.chdir(home)
    first = {"models": [], "schema": [], "import": [str(ROOT / "models" / "stage.rexs")], "new": ["new.toml"]}
    try:
        code = _command([command, *first.get(command, ["model.toml"]), *options])
        there = {path.relative_to(home).as_posix() for path in home.rglob("*")}
        hidden = sorted(name for name in there if Path(name).name.startswith("."))
        assert not hidden, f"left behind: {hidden}"
        # A command that takes no model may be told to write over one.
        read = {path: data for path, data in inputs.items() if path.name != "model.toml" or command not in first}
        changed = [path.name for path, data in read.items() if path.read_bytes() != data]
        assert not changed, f"inputs changed: {changed}"
        new = there - {path.name for path in inputs} - {"folder", "pipe"}
        assert code == 0 or not new, f"refused, and written: {sorted(new)}"
    finally:
        os.chdir(before)
        shutil.rmtree(home, ignore_errors=True)


def _command(arguments: list[str]) -> int:
    """Exit code of the command line in this process; what typer refuses is as good as a sentence."""
    from rotorgear.cli.main import app

    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()) as said:
        try:
            app(arguments)
        except SystemExit as end:
            if end.code not in (0, 2):
                raise AssertionError(f"exit code {end.code}: {said.getvalue()}") from None
            return int(end.code or 0)
        except RotorgearError as error:
            if not str(error).strip():
                raise AssertionError("refused without a word") from None
            return 2
    return 0


def chosen(verbs: str, seed: int) -> dict[str, Verb]:
    """The verbs of a seed: all, the quick ones, or the quick ones and one that is drawn."""
    return drawn(seed) if verbs == "drawn" else ALL if verbs == "all" else QUICK


def _work(pipe: Connection, verbs: str, limit: float) -> None:
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    with tempfile.TemporaryDirectory() as folder:
        while (task := pipe.recv()) is not None:
            kind, seed = task
            start = time.process_time()
            findings, ends = run_seed(seed, chosen(verbs, seed), Path(folder), limit, kind)
            memory = largest_memory() or 0.0
            if memory > _MOST_MEMORY:
                findings.append(
                    Finding(seed, kind, "?", f"more than {_MOST_MEMORY:.0e} bytes of memory", f"{memory:.2g}")
                )
                ends["found"] += 1
            pipe.send((seed, findings, ends, time.process_time() - start))
            if memory > _MOST_MEMORY:
                return  # another worker goes on: this one's largest memory stays


def main() -> int:
    """Run the command; 1 where there is any finding."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    parser.add_argument(
        "--files", type=int, help="number of mutants of models, options and rigs (default: the whole counts)"
    )
    parser.add_argument("--share", type=float, default=1.0, help="share of the whole counts, such as 0.1 (default 1)")
    parser.add_argument("--kind", help="of the whole counts only this kind, such as options or 'long report'")
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
        kind = asked.kind or kind_of(asked.show)
        if kind.startswith("long "):
            text = long_mutant(asked.show)
        else:
            text = mutant(asked.show)[1] if kind == "model" else " ".join(option_mutations(asked.show))
        sys.stdout.write(text + "\n")
        return 0
    if asked.files is None and asked.verbs == "all":
        asked.verbs = "drawn"
    tasks = tasks_of(asked)
    kinds = collections.Counter(kind for kind, _ in tasks)
    print(f"seeds from {asked.seed} on: " + ", ".join(f"{count} {kind}" for kind, count in kinds.items()), flush=True)
    done, findings, ends, slowest = run(asked, tasks)
    groups = collections.Counter((found.verb.split(" ")[0], found.what) for found in findings)
    for (verb, what), count in groups.most_common():
        first = next(found for found in findings if (found.verb.split(" ")[0], found.what) == (verb, what))
        print(f"{count:4} x {verb}: {what} (seed {first.seed}, {first.kind}: {first.verb}): {first.details[:160]}")
    total = ", ".join(f"{count} {name}" for name, count in sorted(ends.items()))
    print(
        f"{done} files from seed {asked.seed}: {total}; {len(findings)} findings; "
        f"slowest file {slowest[0]:.1f} CPU s (seed {slowest[1]})"
    )
    return 1 if findings else 0


def tasks_of(asked: argparse.Namespace) -> list[tuple[str, int]]:
    """Kind and seed of all that is run: a number of files as their seeds say, or the whole counts."""
    if asked.files is not None:
        return [(kind_of(seed), seed) for seed in range(asked.seed, asked.seed + asked.files)]
    tasks = []
    for kind, count in COUNTS.items():
        for one in [f"long {verb}" for verb in LONG] if kind == "long" else [kind]:
            if asked.kind in (None, kind, one):
                tasks += [(one, asked.seed + k) for k in range(math.ceil(asked.share * count))]
    return tasks


def run(
    asked: argparse.Namespace, tasks: list[tuple[str, int]]
) -> tuple[int, list[Finding], collections.Counter, tuple[float, int]]:
    """Number of seeds gone through, findings, how the runs ended, and the slowest seed; a worker that dies is replaced."""
    last = time.monotonic() + asked.seconds
    context = multiprocessing.get_context("spawn")
    waiting = collections.deque(tasks)
    findings: list[Finding] = []
    ends: collections.Counter = collections.Counter()
    slowest = (0.0, -1)
    workers: dict[Connection, tuple[Any, tuple[str, int]]] = {}
    report = asked.report.open("a", encoding="utf-8") if asked.report else None

    def begin() -> None:
        ours, theirs = context.Pipe()
        process = context.Process(target=_work, args=(theirs, asked.verbs, asked.limit), daemon=True)
        process.start()
        theirs.close()
        give(ours, process)

    def give(pipe: Connection, process: Any) -> None:
        task = waiting.popleft() if waiting and time.monotonic() < last else None
        try:
            pipe.send(task)
        except BrokenPipeError:  # it ended after its last answer
            workers.pop(pipe, None)
            if task is not None:
                waiting.appendleft(task)
                begin()
            return
        if task is None:
            workers.pop(pipe, None)
            process.join()
        else:
            workers[pipe] = (process, task)

    for _ in range(min(asked.jobs, len(tasks))):
        begin()
    done = 0
    while workers:
        for pipe in multiprocessing.connection.wait(list(workers)):
            process, (kind, seed) = workers[pipe]
            try:
                _, found, how, spent = pipe.recv()
            except (EOFError, ConnectionResetError):
                process.join()
                del workers[pipe]
                found, how, spent = (
                    [Finding(seed, kind, "?", f"crash, exit code {process.exitcode}", "")],
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
                sys.stderr.write(f"\r{done} of {len(tasks)} files, {len(findings)} findings")
    return done, findings, ends, slowest
