"""What broke it once: each hole that was found by trying is held shut here.

Caches that serve old code are held in tests/contract/test_fresh_code.py, streams in tests/unit/export/test_stream.py.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.sweep import cluster as clusters
from rotorgear.cli import main as command_line
from rotorgear.errors import AnalysisError, ConvergenceError, ModelError, RotorgearError
from rotorgear.export.hdf5 import ReadError
from rotorgear.export.stream import ChunkStream
from rotorgear.files.write import WriteError, write_json
from tests.extreme.models import points
from tests.paths import ROOT

JEFFCOTT = ROOT / "models" / "jeffcott.toml"


@pytest.fixture(scope="module")
def modes() -> rg.ModalResult:
    return rg.modal(rg.load(JEFFCOTT), modes=4)


def said(arguments: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> tuple[int, str]:
    """Exit code of a command in this process, and what it says on stderr."""
    monkeypatch.setattr(sys, "argv", ["rotorgear", *arguments])
    try:
        command_line.main()
        code = 0
    except SystemExit as end:
        code = int(end.code or 0)
    return code, capsys.readouterr().err


# --- 3: --resume ---------------------------------------------------------------------------------------------


def chunks_of_three(path: Path) -> Path:
    stream = ChunkStream(path)
    stream.begin({"grid": "as asked"})
    for number in range(3):
        stream.write({"t": np.arange(10.0) + 10 * number})
    return stream.folder


def drop_the_second(folder: Path) -> None:
    (folder / "chunk_000002.h5").unlink()


def put_nan(folder: Path) -> None:
    with h5py.File(folder / "chunk_000002.h5", "r+") as file:
        file["t"][3] = np.nan


def cut_off(folder: Path) -> None:
    os.truncate(folder / "chunk_000003.h5", 700)


def spoil_settings(folder: Path) -> None:
    (folder / "settings.json").write_text("{", encoding="utf-8")


def forget_settings(folder: Path) -> None:
    (folder / "settings.json").unlink()


@pytest.mark.parametrize(
    ("damage", "sentence"),
    [
        (drop_the_second, "has no chunk_000002.h5, but later ones: remove those to go on from there"),
        (put_nan, r"chunk_000002\.h5 is damaged: remove it and all chunks after it"),
        (cut_off, r"chunk_000003\.h5 is damaged: remove it"),
        (spoil_settings, r"settings\.json is damaged: start without resume"),
        (forget_settings, r"settings\.json is damaged: start without resume"),
    ],
)
def test_chunks_that_do_not_fit_together_are_not_gone_on_with(
    tmp_path: Path, damage: Callable[[Path], None], sentence: str
) -> None:
    folder = chunks_of_three(tmp_path / "run.h5")
    assert len(ChunkStream(tmp_path / "run.h5", resume=True).begin({"grid": "as asked"})) == 3
    damage(folder)
    with pytest.raises(RotorgearError, match=sentence):
        ChunkStream(tmp_path / "run.h5", resume=True).begin({"grid": "as asked"})


# --- 4: results in HDF5 --------------------------------------------------------------------------------------


def nan_eigenvalue(file: h5py.File) -> None:
    file["eigenvalues"][1] = np.nan


def one_eigenvalue(file: h5py.File) -> None:
    kept = file["eigenvalues"][:1]
    kind = file["eigenvalues"].attrs["type"]
    del file["eigenvalues"]
    file["eigenvalues"] = kept
    file["eigenvalues"].attrs["type"] = kind


def huge(shape: tuple[int, ...], **layout: Any) -> Callable[[h5py.File], None]:
    def put(file: h5py.File) -> None:
        del file["eigenvalues"]
        file.create_dataset("eigenvalues", shape, "f8", **layout).attrs["type"] = "array"

    return put


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (nan_eigenvalue, "its values are not those that rotorgear wrote"),
        (one_eigenvalue, "its values are not those that rotorgear wrote"),
        (huge((10**12,), chunks=(10**6,)), "says that it has 1e[+]12 values, more than the file has bytes"),
        (
            huge((3 * 10**8,), chunks=(10**6,), compression="gzip"),
            "says that it has 3e[+]08 values, more than the file",
        ),
    ],
)
def test_a_result_that_was_changed_after_it_was_saved_is_refused(
    modes: rg.ModalResult, tmp_path: Path, change: Callable[[h5py.File], None], sentence: str
) -> None:
    path = rg.save(modes, tmp_path / "modes.h5")
    assert rg.read(path) == modes
    with h5py.File(path, "r+") as file:
        change(file)
    with pytest.raises(ReadError, match=sentence):
        rg.read(path)


# --- 5, 10: lists of rig lines -------------------------------------------------------------------------------


def test_a_quote_that_is_not_closed_is_refused_in_its_line(tmp_path: Path) -> None:
    (tmp_path / "rig.csv").write_text('frequency_hz,label\n361,"first\n420,second\n515,third\n', encoding="utf-8")
    with pytest.raises(ModelError, match=r"rig\.csv:2: got '361,\"first', expected every quote closed in its line"):
        rg.read_rig_lines(tmp_path / "rig.csv")


def test_a_decimal_comma_is_read_beside_semicolons_and_tabs(tmp_path: Path) -> None:
    for delimiter in ";\t":
        rows = ["frequency_hz;label;damping", "361,5;1,5 mm left;1,25 %", '420;"3,1";', "515,25 Hz;;0,01"]
        (tmp_path / "rig.csv").write_text("\n".join(rows).replace(";", delimiter), encoding="utf-8")
        lines = rg.read_rig_lines(tmp_path / "rig.csv")
        assert [line.frequency_hz for line in lines] == [361.5, 420.0, 515.25]
        assert [line.damping_ratio for line in lines] == [0.0125, None, 0.01]
        assert [line.label for line in lines] == ["1,5 mm left", "3,1", ""]


def test_two_decimal_signs_in_one_list_are_refused_since_one_may_part_thousands(tmp_path: Path) -> None:
    (tmp_path / "rig.csv").write_text("frequency_hz;label\n1,361;a\n420.5;b\n", encoding="utf-8")
    with pytest.raises(
        ModelError, match=r"rig.csv:3:frequency: got '420.5', expected one decimal sign .*line 2 has ','"
    ):
        rg.read_rig_lines(tmp_path / "rig.csv")


def test_a_thousand_rig_lines_are_compared(modes: rg.ModalResult) -> None:
    found = rg.compare(modes, [*np.geomspace(1.0, 3000.0, 1030)], samples=2)
    assert 0.0 <= found.chance.binomial_probability <= 1.0


# --- 6, 14: gears and disks ----------------------------------------------------------------------------------

GEAR = {
    "shaft": "s",
    "kind": "spur",
    "teeth": 20,
    "normal_module": "2 mm",
    "normal_pressure_angle": "20 deg",
    "width": "20 mm",
}


@pytest.mark.parametrize(
    ("first", "second", "sentence"),
    [
        (0.1, 0.1, "gears.a and gears.b stand in one another on shaft 's' (over 20 mm)"),
        (0.1, 0.115, "gears.a and gears.b stand in one another on shaft 's' (over 5 mm)"),
        (0.1, 0.2, "gears.b: its face hangs over the end of shaft 's' by 10 mm"),
        (0.005, 0.1, "gears.a: its face hangs over the end of shaft 's' by 5 mm"),
        (0.1, 0.12, ""),
        (0.01, 0.19, ""),
    ],
)
def test_gears_in_one_another_or_beyond_their_shaft_are_told(first: float, second: float, sentence: str) -> None:
    shaft = {"sections": [{"length": "0.2 m", "outer_diameter": "20 mm"}]}
    gears = {"a": {**GEAR, "at": first}, "b": {**GEAR, "at": second}}
    found = rg.check(rg.Model(shafts={"s": shaft}, gears=gears)).warnings
    assert found == () if not sentence else any(warning.startswith(sentence) for warning in found)


def test_a_flat_disk_written_with_six_digits_is_taken(tmp_path: Path) -> None:
    disk = "mass = 1e-9\npolar_inertia = {}\ndiametral_inertia = {}\n"
    text = (
        '[shafts.s]\nsections = [{{length = "1 m", outer_diameter = "1 mm"}}]\n[disks.d]\nshaft = "s"\nat = 0.5\n'
        + disk
    )
    path = tmp_path / "flat.toml"
    for diametral in (9.54673e-13, 1.04999e-12, 1.00001e-12):
        path.write_text(text.format(f"{2.0 * diametral * (1 + 4.9e-6):.5e}", f"{diametral:.5e}"), encoding="utf-8")
        rg.load(path)
    path.write_text(text.format("2.0001e-12", "1e-12"), encoding="utf-8")
    with pytest.raises(ModelError, match="at most twice"):
        rg.load(path)


# --- 7: errors of libraries ----------------------------------------------------------------------------------


def test_a_library_of_units_that_does_not_work_is_no_fault_of_the_user(monkeypatch: pytest.MonkeyPatch) -> None:
    import pint

    from rotorgear import quantity

    def broken(**_: Any) -> Any:
        raise TypeError("ParsedProject.__init__() missing 1 required positional argument")

    quantity._registry.cache_clear()
    monkeypatch.setattr(pint, "UnitRegistry", broken)
    with pytest.raises(
        RotorgearError, match=r"pint .* can't read its own list of units .*: install pint 0.24.4 or newer"
    ):
        quantity.parse_quantity("3 furlong", "length")


# --- 8, 9: what has no inertia, and what is too long ---------------------------------------------------------


def motor_end(damping: float = 0.0) -> rg.Model:
    """A chain of two disks, driven by the end of a motor that nobody weighed, which a support holds along z."""
    hold = rg.Support(
        shaft="p0",
        at=0.0,
        stiffness=rg.StiffnessMatrix(axial=1e6),
        damping=rg.DampingMatrix(axial=damping) if damping else None,
    )
    fixed = {f"z{k}": rg.Support(shaft=f"p{k}", at=0.0, fixed=("z",)) for k in (1, 2)}
    return points([0.0, 0.3, 0.2], [1e5, 1e5], supports={"s": hold, **fixed}, motions=("torsion", "axial"))


def test_springs_without_inertia_have_no_modes_and_are_left_out_by_name() -> None:
    left_out = "modes of what has stiffness but no inertia: z of shaft 'p0' at z = 0 m"
    exact = np.sqrt(1e5 * (1 / 0.3 + 1 / 0.2))
    for speed in (None, 100.0):
        found = rg.modal(motor_end(), speed=speed)
        assert np.abs(found.eigenvalues[~found.rigid]) == pytest.approx([exact], rel=1e-12)
        assert left_out in found.left_out
    over_speed = rg.campbell(motor_end(), stop=100.0, points=3)
    assert np.abs(over_speed.eigenvalues) == pytest.approx(exact, rel=1e-9)


def test_dampers_without_inertia_are_refused_by_name() -> None:
    for verb in (rg.modal, rg.campbell):
        arguments = {"speed": 100.0} if verb is rg.modal else {"stop": 100.0, "points": 3}
        with pytest.raises(
            AnalysisError, match="dampers but no inertia: z of shaft 'p0' at z = 0 m; give the body there"
        ):
            verb(motor_end(10.0), **arguments)


def test_a_branch_that_is_rigid_at_standstill_is_drawn_where_it_oscillates() -> None:
    # A disk that nothing holds against tilting: |s| = W I_p / I_d, which is no oscillation at standstill.
    disk = rg.Disk(shaft="p", at=0.0, mass=0.0, polar_inertia=0.1, diametral_inertia=0.08)
    mass = rg.PointMass(shaft="q", at=0.0, mass=1.0)
    supports = {
        "p": rg.Support(shaft="p", at=0.0, fixed=("x", "y")),
        "q": rg.Support(shaft="q", at=0.0, stiffness=rg.StiffnessMatrix(radial=1e6), fixed=("tilt_x", "tilt_y")),
    }
    model = rg.Model(
        shafts={"p": rg.Shaft(), "q": rg.Shaft(speed_ratio=1.0)},
        disks={"d": disk},
        point_masses={"m": mass},
        supports=supports,
        motions=("bending",),
    )
    found = rg.campbell(model, stop=100.0, points=3)
    branch = np.flatnonzero(np.isnan(found.eigenvalues[0]))  # at standstill it is not there
    assert len(branch) == 1
    assert np.abs(found.eigenvalues[1:, branch[0]]) == pytest.approx([50.0 * 1.25, 100.0 * 1.25], rel=1e-9)


def slender(length: float) -> rg.Model:
    """A pinned shaft of 20 mm: w = (pi/L)^2 (d/4) sqrt(E/rho), where shear and rotary inertia are nothing."""
    pins = {end: rg.Support(shaft="s", at=end, fixed=("x", "y")) for end in ("start", "end")}
    section = rg.Section(length=length, outer_diameter=0.02)
    return rg.Model(shafts={"s": rg.Shaft(sections=(section,))}, supports=pins, motions=("bending",))


@pytest.mark.parametrize("length", [1e3, 1e5, 1e6])
def test_a_shaft_as_long_as_a_country_is_right(length: float) -> None:
    found = rg.modal(slender(length), modes=4, elements=8)
    exact = [(n * np.pi / length) ** 2 * 0.005 * np.sqrt(206e9 / 7850.0) for n in (1, 1, 2, 2)]
    assert np.abs(found.eigenvalues) == pytest.approx(exact, rel=1e-3)


def test_parts_of_thirty_decades_are_refused_by_name() -> None:
    model = rg.load(JEFFCOTT).with_("shafts.rotor.sections[0].length", 1e6)
    with pytest.raises(
        ConvergenceError, match=r"decades apart in omega.2 .*shaft rotor.*: leave out what is negligible"
    ):
        rg.modal(model)


# --- 11, 12, 13: files and interrupts ------------------------------------------------------------------------


@pytest.mark.parametrize("command", ["campbell", "accuracy", "static", "response", "gear"])
def test_a_picture_of_no_kind_is_refused_before_the_model_is_read(
    command: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    code, words = said([command, "no_such_file.toml", "--plot", "picture.bmp"], monkeypatch, capsys)
    assert (code, words) == (2, "a plot is written as PNG, SVG or PDF by the ending of its name; got 'picture.bmp'\n")


def test_places_that_take_no_file_are_told_in_a_sentence(modes: rg.ModalResult, tmp_path: Path) -> None:
    (tmp_path / "loop").symlink_to("loop")
    places = {
        "/dev/full": "no space left on device",
        str(tmp_path / "loop"): "symlink loop|symbolic links",
        "a" * 300: "file name too long",
    }
    for place, sentence in places.items():
        with pytest.raises(WriteError, match=f"can't be written: .*({sentence})"):
            rg.save(modes, place)
        with pytest.raises(WriteError, match=f"can't be written: .*({sentence})"):
            write_json(modes.to_dict(), place)


@contextmanager
def no_file_above(size: int) -> Iterator[None]:
    """As on a full disk, a write beyond so many bytes fails."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_a_full_disk_is_told_in_one_line_and_nothing_is_left(
    modes: rg.ModalResult, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("pyvista")
    for write in (
        lambda: rg.save(modes, tmp_path / "modes.h5"),
        lambda: write_json(modes.to_dict(), tmp_path / "modes.json"),
        lambda: rg.write_vtk(modes, tmp_path / "vtk", modes=[1]),
    ):
        with no_file_above(512), pytest.raises(WriteError) as caught:
            write()
        assert str(caught.value).count("\n") == 0
        assert "can't be written: " in str(caught.value)
    assert [path for path in tmp_path.rglob("*") if path.is_file()] == []
    assert capfd.readouterr() == ("", "")


def test_an_output_that_takes_nothing_is_told() -> None:
    command = [sys.executable, "-m", "rotorgear", "--version"]
    with open("/dev/full", "w") as full:
        done = subprocess.run(command, cwd=ROOT, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert (done.returncode, done.stderr) == (2, "the output can't be written: no space left on device\n")
    closed = subprocess.run(["sh", "-c", '"$@" >&-', "sh", *command], cwd=ROOT, capture_output=True, check=False)
    assert (closed.returncode, closed.stderr) == (0, b"")


def test_an_interrupt_is_told(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def interrupted(_: Path) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(rg, "load", interrupted)
    code, words = said(["modal", str(JEFFCOTT)], monkeypatch, capsys)
    assert (code, words) == (130, "interrupted; nothing half-written is left behind\n")


# --- 15: counts that are none --------------------------------------------------------------------------------


@pytest.mark.parametrize("count", [2.5, "3", True, np.nan])
def test_a_count_that_is_no_whole_number_is_refused(count: Any) -> None:
    model = rg.load(JEFFCOTT)
    for call in (
        lambda: rg.modal(model, modes=count),
        lambda: rg.modal(model, elements=count),
        lambda: rg.campbell(model, modes=count),
        lambda: rg.campbell(model, points=count),
        lambda: rg.critical(model, elements=count),
        lambda: rg.static(model, elements=count),
        lambda: rg.frf(model, inputs=["probe_x"], outputs=["probe_x"], fmax=10.0, points=count),
    ):
        with pytest.raises(AnalysisError, match=r"the number of .* must be a whole number, got"):
            call()


# --- 16: what a cluster opens --------------------------------------------------------------------------------


def listening() -> set[str]:
    """Addresses (hexadecimal) that the sockets of this process and its children listen on."""
    here = os.getpid()
    family = {here}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):
            fields = stat.read_text().rpartition(")")[2].split()
            if int(fields[1]) == here:
                family.add(int(stat.parent.name))
    sockets = set()
    for number in family:
        for link in Path(f"/proc/{number}/fd").iterdir():
            with suppress(OSError):
                sockets.add(os.readlink(link).removeprefix("socket:[").rstrip("]"))
    tables = [
        line.split() for name in ("tcp", "tcp6") for line in Path(f"/proc/net/{name}").read_text().splitlines()[1:]
    ]
    return {row[1].partition(":")[0] for row in tables if row[3] == "0A" and row[9] in sockets}


@pytest.mark.skipif(not Path("/proc/net/tcp").exists(), reason="sockets are listed by Linux")
def test_workers_of_this_machine_listen_to_this_machine_only() -> None:
    pytest.importorskip("distributed")
    before = listening()
    with clusters.cluster("local:1"):
        assert listening() - before == {"0100007F"}  # 127.0.0.1


# --- 17: size ------------------------------------------------------------------------------------------------


def test_a_check_costs_the_same_for_each_shaft_however_many_there_are(monkeypatch: pytest.MonkeyPatch) -> None:
    def calls(count: int) -> int:
        shafts = {f"s{k}": {"sections": [{"length": 0.1, "outer_diameter": 0.02}]} for k in range(count)}
        bearings = {f"b{k}": {"shaft": f"s{k}", "at": 0.0, "stiffness": {"radial": 1e8}} for k in range(count)}
        model = rg.Model(shafts=shafts, bearings=bearings)
        counted = 0

        def count_call(frame: Any, event: str, argument: Any) -> None:
            nonlocal counted
            counted += event == "call" or event == "c_call"

        sys.setprofile(count_call)
        try:
            rg.check(model)
        finally:
            sys.setprofile(None)
        return counted

    calls(2)  # what is imported and cached at the first time
    assert calls(80) < 1.1 * 4 * calls(20)
