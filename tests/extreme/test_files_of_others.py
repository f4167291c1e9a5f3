"""What a colleague sends neither hangs nor fills the machine nor reaches the terminal; what is written harms no input.

Each case runs as a command of its own, within a CPU second and 200 MB: one sentence, exit code 2, and no input changed.
"""

from __future__ import annotations

import base64
import os
import re
import resource
import stat
import subprocess
import sys
import zipfile
import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from rotorgear.casings.mesh_file import read_mesh
from rotorgear.cli.main import main
from rotorgear.errors import AnalysisError
from rotorgear.files.bounds import MOST_LISTED
from rotorgear.system.system import System
from tests.paths import ROOT
from tests.unit.casings.blocks import block, write_inp

pytestmark = pytest.mark.skipif(os.name == "nt", reason="devices, pipes and modes")

JEFFCOTT = (ROOT / "models" / "jeffcott.toml").read_text(encoding="utf-8")
_CPU, _MEMORY = 1.0, 200e6
# Runs a command, then tells CPU seconds and memory of it.
WATCH = """
import os, resource, subprocess, sys
done = subprocess.run([sys.executable, "-m", "rotorgear", *sys.argv[1:]], stdin=subprocess.PIPE, check=False)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
print("WATCHED", done.returncode, used.ru_utime + used.ru_stime, used.ru_maxrss * 1024)
"""


# Where 1 CPU s is too little for the machine, a refusal may take so many starts of Python with numpy and pydantic. The number was
# chosen to pass on a slow machine: refusals took 8 to 10 of them there.
_STARTS = 12


def start_of_python() -> float:
    """CPU s of a start of Python with numpy and pydantic, which knows nothing of rotorgear: the least of three."""
    start = "import time, numpy, pydantic, json, tomllib, xml.etree.ElementTree; print(time.process_time())"
    runs = [subprocess.run([sys.executable, "-c", start], capture_output=True, check=True) for _ in range(3)]
    return min(float(run.stdout) for run in runs)


def watched(folder: Path, *arguments: str, **environment: str) -> tuple[str, str, str, str, str]:
    """stdout, stderr, exit code, CPU seconds and bytes of a command."""
    done = subprocess.run(
        [sys.executable, "-c", WATCH, *arguments],
        cwd=folder,
        # With bytecode on the disk, as users have it, whatever the environment of the tests says.
        env={**os.environ, "PYTHONDONTWRITEBYTECODE": "", "PYTHONPATH": str(ROOT), **environment},
        capture_output=True,
        timeout=60,
        check=False,
    )
    out, error = (text.decode("utf-8", "backslashreplace") for text in (done.stdout, done.stderr))
    out, _, measured = out.rpartition("WATCHED")
    code, cpu, memory = measured.split()
    return out, error, code, cpu, memory


def run(folder: Path, *arguments: str, **environment: str) -> tuple[int, str, str]:
    """Exit code, stdout and stderr of a command; no traceback, and within the bounds where it was refused."""
    before = {path: (path.read_bytes(), path.stat().st_mode) for path in folder.iterdir() if path.is_file()}
    out, error, code, cpu, memory = watched(folder, *arguments, **environment)
    assert "Traceback" not in error
    if code == "2":
        if float(cpu) >= _CPU:  # once more, with the bytecode there
            cpu = watched(folder, *arguments, **environment)[3]
        assert float(cpu) < _CPU or float(cpu) < _STARTS * start_of_python()
        assert float(memory) < _MEMORY
        assert before == {path: (path.read_bytes(), path.stat().st_mode) for path in folder.iterdir() if path.is_file()}
    return int(code), out, error


def with_history(file: str) -> Callable[[Path], str]:
    return lambda folder: JEFFCOTT + f'\n[loads.f]\nshaft = "rotor"\nat = "end"\nhistory = "{file}"\n'


def with_pipe(folder: Path) -> str:
    os.mkfifo(folder / "pipe")
    return with_history("pipe")(folder)


def with_blanks(count: int) -> Callable[[Path], str]:
    return lambda folder: re.sub('(outer_diameter = "[^"]*)', rf"\g<1>{' ' * count}x", JEFFCOTT, count=1)


MODELS: dict[str, tuple[Callable[[Path], str], str]] = {
    "zeros without end": (with_history("/dev/zero"), "it is a device"),
    "a terminal": (with_history("/dev/stdin"), "it is a pipe"),
    "a pipe": (with_pipe, "it is a pipe"),
    "30,000 blanks": (with_blanks(30_000), "up to 1000 letters"),
    "900 blanks": (with_blanks(900), "expected a length"),
    "dotted key": (lambda folder: "a" + ".a" * 16_000 + " = 1\n", "more than 64 parts"),
    "quoted dotted key": (lambda folder: "[x]\nb = {'a'" + ' . "a"' * 16_000 + " = 1}\n", "more than 64 parts"),
    "10 MB": (lambda folder: JEFFCOTT + "#" * 10_000_000, "larger than 8 MB"),
    "a long row": (
        lambda folder: (
            (folder / "t.csv").write_text(f"time_s,force_y_N\n0,{'1' * 200_000}\n1,2\n")
            and with_history("t.csv")(folder)
        ),
        "field limit",
    ),
}


@pytest.mark.parametrize("name", MODELS)
def test_a_model_that_would_hang_is_refused_in_a_sentence(tmp_path: Path, name: str) -> None:
    make, sentence = MODELS[name]
    (tmp_path / "m.toml").write_text(make(tmp_path), encoding="utf-8")
    code, _, error = run(tmp_path, "check", "m.toml")
    assert (code, sentence in error) == (2, True), error


def packed(name: str, text: str, method: int = zipfile.ZIP_STORED) -> Callable[[Path], None]:
    def make(path: Path) -> None:
        with zipfile.ZipFile(path, "w", method, compresslevel=9) as archive:
            archive.writestr(name, text)

    return make


def of_components(one: str, count: int) -> str:
    """A gearbox of so many components; {k} is the number of each, {next} that of the one after it."""
    many = "".join(one.replace("{k}", str(k)).replace("{next}", str(k + 1)) for k in range(count))
    return f"<model><components>{many}</components></model>"


FRAME = (
    '<component id="{k}" type="shaft"><attribute id="support_vector" unit="mm"><array><c>0</c><c>0</c><c>1</c></array>'
    '</attribute><attribute id="reference_component_for_position">{next}</attribute></component>'
)
REXS: dict[str, tuple[Callable[[Path], object], str]] = {
    "utf-7": (lambda path: path.write_text('<?xml version="1.0" encoding="utf-7"?><model/>'), "multi-byte encodings"),
    "elements": (packed("a.rexs", "<model>" + "<a/>" * 7_000_000 + "</model>"), "more than 500000 elements"),
    "large": (
        packed("a.rexs", "<model>" + "<a/>" * 10_000_000 + "</model>", zipfile.ZIP_DEFLATED),
        "unpacked it is larger than 32 MB",
    ),
    "tight": (
        packed("a.rexs", "<model>" + "<a/>" * 7_000_000 + "</model>", zipfile.ZIP_DEFLATED),
        "it unpacks to more than 100 times its size",
    ),
    "lists": (packed("a.rexsj", '{"model":[' + "[]," * 9_000_000 + "[]]}"), "more than 500000 elements"),
    "a tag": (packed("a.rexs", f"<model x='{'y' * 29_000_000}'/>"), "a tag or a comment of more than"),
    "deep": (packed("a.rexs", "<a>" * 400_000), "its root is <a>"),
    "entities": (
        lambda path: path.write_text('<!DOCTYPE m [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;">]><model>&b;</model>'),
        "document type",
    ),
    "a pipe": (os.mkfifo, "it is a pipe"),
    "components": (packed("a.rexs", of_components('<component id="{k}"/>', 20_000)), "more than 10000 components"),
    "9000 shafts": (packed("a.rexs", of_components('<component id="{k}" type="shaft" name="n"/>', 9000)), "problems"),
    "frames in frames": (packed("a.rexs", of_components(FRAME, 1500)), "frames in frames go 100 deep"),
}


@pytest.mark.parametrize("name", REXS)
def test_a_gearbox_that_unpacks_to_more_than_any_has_is_refused(tmp_path: Path, name: str) -> None:
    make, sentence = REXS[name]
    make(tmp_path / "g.rexsz")
    code, _, error = run(tmp_path, "import", "g.rexsz", "-o", "m.toml")
    assert (code, sentence in error) == (2, True), error
    assert not (tmp_path / "m.toml").exists()


@pytest.mark.parametrize(
    "arguments", ["modal {} --json {}", "sensors {} -o {}", "modal {} --save {}", "report {} --json {}"]
)
def test_the_model_is_never_written_over(tmp_path: Path, arguments: str) -> None:
    (tmp_path / "m.toml").write_text(JEFFCOTT, encoding="utf-8")
    (tmp_path / "m.toml").chmod(0o600)
    (tmp_path / "other").symlink_to("m.toml")
    for name in ("m.toml", "other"):
        code, _, error = run(tmp_path, *arguments.format("m.toml", name).split())
        assert code == 2
        assert "this run reads it" in error


def test_a_table_that_the_model_names_is_not_written_over(tmp_path: Path) -> None:
    (tmp_path / "t.csv").write_text("time_s,force_y_N\n0,1\n1,2\n")
    (tmp_path / "m.toml").write_text(with_history("t.csv")(tmp_path), encoding="utf-8")
    code, _, error = run(tmp_path, "modal", "m.toml", "--json", "t.csv")
    assert (code, "this run reads it" in error) == (2, True)


def test_outputs_and_options_are_refused_before_anything_is_computed(tmp_path: Path) -> None:
    (tmp_path / "m.toml").write_text(JEFFCOTT, encoding="utf-8")
    (tmp_path / "old.json").write_text("old")
    (tmp_path / "old.json").chmod(0o444)
    for arguments, sentence in (
        ("modal m.toml --json nowhere/x.json", "there is no folder"),
        ("modal m.toml --json old.json", "read-only"),
        ("modal m.toml --vtk m.toml/x", "a file stands in the way"),
        ("modal m.toml --json x --save x", "--json and --save would both be written to x"),
        ("report m.toml --json /", "it is a folder"),
        ("report m.toml --grade -1", "grade: expected"),
        ("report m.toml --modal-damping 2", "must lie between 0 and 1"),
        ("response m.toml --modal-damping 1_0", "not a valid float"),
        ("modal m.toml --modes ٣", "not a valid integer"),
        ("modal m.toml --shapes ² --uff x.unv", "expected numbers of modes"),
    ):
        code, _, error = run(tmp_path, *arguments.split())
        assert (code, sentence in error) == (2, True), (arguments, error)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["m.toml", "old.json"]


def test_a_file_keeps_its_mode_when_a_result_replaces_it(tmp_path: Path) -> None:
    (tmp_path / "m.toml").write_text(JEFFCOTT, encoding="utf-8")
    (tmp_path / "x.json").write_text("{}")
    (tmp_path / "x.json").chmod(0o600)
    assert run(tmp_path, "check", "m.toml", "--json", "x.json")[0] == 0
    assert stat.S_IMODE((tmp_path / "x.json").stat().st_mode) == 0o600


def test_no_title_is_obeyed_by_the_terminal_or_ends_a_run(tmp_path: Path) -> None:
    title = r'title = "歯車 \\u001b]0;owned\\u0007\\u001b[2J\\u202ex"'
    (tmp_path / "m.toml").write_text(re.sub(r"(?m)^title.*$", title, JEFFCOTT), encoding="utf-8")
    for encoding in ("ascii", "latin-1", "utf-8"):
        code, out, _ = run(
            tmp_path, "check", "m.toml", "--json", "x.json", PYTHONIOENCODING=encoding, PYTHONUTF8="0", LC_ALL="C"
        )
        assert code == 0
        assert not re.search("[\x00-\x08\x1b\x07\u202e]", out)
        assert "owned" in out
        assert "歯車" in (tmp_path / "x.json").read_text(encoding="utf-8")


def test_an_inertia_beyond_double_precision_is_named(tmp_path: Path) -> None:
    text = (ROOT / "models" / "marine_double_reduction.toml").read_text(encoding="utf-8")
    text = re.sub(r'(?s)(\[gears\.bull\].*?polar_inertia = ")[^ "]*', r"\g<1>8e-295", text, count=1)
    (tmp_path / "m.toml").write_text(text, encoding="utf-8")
    code, _, error = run(tmp_path, "modal", "m.toml")
    assert (code, "look at gears.bull.polar_inertia" in error) == (2, True), error


# --- meshes --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("last", ["4000000", "1000000000000, 1", "999999999999999999, 7"])
def test_a_range_of_a_deck_is_cut_with_the_nodes_that_there_are(tmp_path: Path, last: str) -> None:
    found = block()
    path = write_inp(tmp_path / "b.inp", found, f"*NSET, NSET=some, GENERATE\n1, {last}\n*NSET, NSET=same\nsome\n")
    sets = read_mesh(path, "casings.b.mesh").sets
    step = int(last.split(",")[1]) if "," in last else 1
    assert np.array_equal(sets["some"].nodes, np.arange(0, len(found.points), step))
    assert np.array_equal(sets["same"].nodes, sets["some"].nodes)


def test_sets_that_name_sets_do_not_double_without_end(tmp_path: Path) -> None:
    text = "*NSET, NSET=s0\n1, 2, 3, 4\n"
    text += "".join(f"*NSET, NSET=s{k + 1}\ns{k}, s{k}\n" for k in range(60))
    path = write_inp(tmp_path / "b.inp", block(), text)
    with pytest.raises(AnalysisError, match=f"a set of more than {MOST_LISTED} numbers"):
        read_mesh(path, "casings.b.mesh")


def test_a_mesh_that_unpacks_to_more_than_any_of_its_size_is_refused(tmp_path: Path) -> None:
    meshio = pytest.importorskip("meshio")
    found = block()
    path = tmp_path / "b.vtu"
    meshio.write(path, meshio.Mesh(found.points, [("tetra10", found.cells["tetra10"])]))
    assert len(read_mesh(path, "casings.b.mesh").points) == len(found.points)
    # Points as one block of zeros, 400 MB of them.
    packed = zlib.compress(bytes(400_000_000), 9)
    head = base64.b64encode(np.array([1, 400_000_000, 0, len(packed)], dtype=np.uint32).tobytes()).decode()
    text = path.read_text()
    begin = text.index(">", text.index('Name="Points"')) + 1
    path.write_text(text[:begin] + head + base64.b64encode(packed).decode() + text[text.index("<", begin) :])
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    with pytest.raises(AnalysisError, match="it unpacks to more than any mesh of its size"):
        read_mesh(path, "casings.b.mesh")
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 200_000
    bytearray(400_000_000)  # the bound is gone


def test_formats_that_name_other_files_are_not_read(tmp_path: Path) -> None:
    for ending in ("xdmf", "xmf", "ele", "node", "h5m", "xml"):
        path = tmp_path / f"b.{ending}"
        path.write_text("<Xdmf/>")
        with pytest.raises(AnalysisError, match="can't be read as a mesh: its ending is none of"):
            read_mesh(path, "casings.b.mesh")
    with pytest.raises(AnalysisError, match="it is a device"):
        read_mesh(Path("/dev/zero"), "casings.b.mesh")


# --- options -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        (
            "transient m.toml --rho-inf 0.5",
            "rho_inf belongs to the method hht or generalised-alpha; the method here is auto",
        ),
        ("transient m.toml --method hht --rho-inf -1", "rho_inf must lie between 0 and 1"),
        ("transient m.toml --method newmark --beta nan", "beta must lie between 0 and 10"),
        ("transient m.toml --steps -1", "the number of steps must be at least 1"),
        ("transient m.toml --spectrum nobody", "there is no history 'nobody'"),
        ("transient m.toml --spectrum left --rig missing.csv", "there is no such file"),
        ("response m.toml --waterfall w.png --at nobody", "is no mesh, bearing or point of the model"),
        ("campbell m.toml --plot p.png --colour nobody", "colour: got 'nobody'"),
        ("modal m.toml --modes 3 --shapes 2,9 --uff m.uff", "there is no mode 9"),
        ("modal m.toml --rig r.csv --tolerance nan", "--tolerance: got nan"),
        ("update m.toml --rig r.csv --tolerance nan", "tolerance: got 'nan'"),
        ("optimise m.toml --free bearings.*.stiffness --seed -1", "the seed can't be negative"),
    ],
)
def test_options_of_what_is_shown_are_judged_before_the_work(
    tmp_path: Path, line: str, sentence: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """In this process: none of the solvers is reached."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "m.toml").write_text(JEFFCOTT, encoding="utf-8")
    (tmp_path / "r.csv").write_text("frequency_hz\n50\n")
    monkeypatch.setattr(System, "__init__", lambda *_, **__: pytest.fail("something was computed"))
    monkeypatch.setattr("sys.argv", ["rotorgear", *line.split()])
    with pytest.raises(SystemExit) as end:
        main()
    assert end.value.code == 2
    assert sentence in capsys.readouterr().err
