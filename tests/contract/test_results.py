"""What every result must hold: a short text, equality, read-only arrays, its origin, declared keys, rows, one vocabulary."""

from __future__ import annotations

import atexit
import json
import pickle
import shutil
import tempfile
from dataclasses import fields, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.rig.compare_responses import OrderCut
from rotorgear.analysis.rig.measured import MeasuredFrf
from rotorgear.analysis.teeth.inside_teeth import tooth_fields
from rotorgear.export.hdf5 import read, save
from rotorgear.model.model import model_hash
from rotorgear.results.kinds import keys_of, kinds
from rotorgear.results.result import Result
from rotorgear.results.schema import Record, of
from rotorgear.results.spectrum import SpectralLines
from rotorgear.results.table import Table, error_words, exact, html_table, written
from tests.models import pair_file, record_beside_a_pair
from tests.paths import ROOT
from tests.unit.analysis.static.test_bearing_states import BALLS
from tests.unit.analysis.static.test_bearing_states import rotor as pulled_rotor
from tests.unit.casings.blocks import block, write_inp

# Names that mean two things since 0.1: files and scripts hold them. A new one is a mistake.
HOMONYMS = {"amplitude", "bearing_force", "bearings", "error_estimate", "mesh", "motion", "reason", "settle"}


@cache
def model(name: str) -> rg.Model:
    return rg.load(ROOT / "models" / f"{name}.toml")


def block_casing() -> rg.Model:
    """A shaft in a block of a few elements, whose mesh lies in a folder that is gone with the process."""
    folder = Path(tempfile.mkdtemp())
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    write_inp(folder / "box.inp", block(kind="tetra"))
    shaft = 'position = [0.05, 0.03]\nstart = 0.2\nsections = [{ length = "1 m", outer_diameter = "20 mm" }]'
    casing = 'mesh = "box.inp"\nunit = "m"\nmaterial = "steel"\nheld = ["low"]\nseats = { left = "high" }'
    bearing = 'shaft = "a"\nat = "start"\nstiffness = { radial = 1e8 }\ncasing = "box"'
    text = f"[shafts.a]\n{shaft}\n[casings.box]\n{casing}\n[bearings.left]\n{bearing}\n"
    return rg.loads(text, folder=folder)


def measured_frf(place: str) -> MeasuredFrf:
    """A response that stands for a measured one."""
    return MeasuredFrf(np.linspace(1.0, 50.0, 8), (place,), (place,), np.ones((1, 8), dtype=complex))


@cache
def example(kind: str) -> Result:
    """A small result of a kind; one whose verb has its name and takes a model alone needs no entry."""
    rotor = model("jeffcott")
    disk = next(iter(rotor.disks))
    made: dict[str, Any] = {
        "modal": lambda: rg.modal(rotor, speed="1000 rpm", modes=4, elements=1),
        "campbell": lambda: rg.campbell(rotor, points=3, elements=1),
        "critical": lambda: rg.critical(rotor, stop="3000 rpm", elements=1),
        "critical_map": lambda: rg.critical_map(rotor, stop="3000 rpm", elements=1),
        "frf": lambda: rg.frf(
            rotor, np.linspace(1.0, 50.0, 8), inputs=[f"disks.{disk}:y"], outputs=[f"disks.{disk}:y"], elements=1
        ),
        "state_space": lambda: rg.state_space(
            rotor, inputs=[f"disks.{disk}:y"], outputs=[f"disks.{disk}:y"], fmax=50.0, modal_damping=0.02, elements=1
        ),
        "static": lambda: rg.static(model("helical_pair"), elements=1),
        "response": lambda: rg.response(model("backlash_pair"), points=3),
        "check": lambda: rg.check(model("geared_pair")),
        "bearing": lambda: rg.bearing(pulled_rotor(BALLS, '["1 kN", "0 N", "0 N"]', "3000 rpm"), stability=False),
        "import": lambda: rg.import_rexs(ROOT / "tests" / "rexs_files" / "sew_3_stage_1.0.rexs"),
        "casing": lambda: rg.casing(block_casing(), modes=2),
        "gear": lambda: rg.gear(model("helical_pair")),
        "mesh": lambda: rg.mesh(model("helical_pair"), stiffness="iso", positions=16),
        "mesh_optimum": lambda: rg.optimise_flanks(
            rg.loads(pair_file()),
            variables=["profile_crowning"],
            over={"torque": [500.0]},
            preset="preview",
            positions=8,
            evaluations=10,
            samples=4,
        ),
        "root_stress": lambda: rg.root_stress(rg.loads(pair_file()), preset="preview", positions=4),
        "mesh_map": lambda: rg.mesh_map(rg.loads(pair_file()), over={"torque": [500.0]}, preset="preview", positions=8),
        "transient": lambda: rg.transient(model("backlash_pair"), time=2e-3, discard=1e-3, error_estimate=False),
        "sweep": lambda: rg.sweep(model("backlash_pair"), {"operation.speed": ["8000 rpm"]}, discard=2, sample=9),
        "orbits": lambda: rg.orbits(model("backlash_pair"), {"operation.speed": "4000 rpm:4200 rpm"}, step=0.5),
        "spectral_lines": lambda: rg.spectral_lines(
            example("transient"),
            f"force {example('transient').contact[0]}",  # type: ignore[attr-defined]
        ),
        "convergence": lambda: rg.convergence_study(model("torsion_chain"), modes=2),
        "mesh_convergence": lambda: rg.mesh_convergence_study(rg.loads(pair_file())),
        "sweep_convergence": lambda: rg.sweep_convergence_study(
            model("backlash_pair"), speed="8000 rpm", steps=[20], counts=[4], starts=2
        ),
        "tooth_field": lambda: tooth_fields(rg.loads(pair_file()), preset="preview"),
        "compare": lambda: rg.compare(example("modal"), [rg.RigLine(101.0)]),
        "compare_shapes": lambda: rg.compare_shapes(
            example("modal"),
            rg.Measured(
                (rg.RigLine(101.0), rg.RigLine(20.0)), (f"disks.{disk}:x", f"disks.{disk}:y"), np.eye(2) + 0.1j
            ),
            samples=5,
        ),
        "compare_frf": lambda: rg.compare_frf(rotor, measured_frf(f"disks.{disk}:y"), elements=1),
        "compare_orders": lambda: rg.compare_orders(
            model("backlash_pair").with_(
                "points", {"p": {"on": f"gears.{next(iter(model('backlash_pair').gears))}", "direction": "torsion"}}
            ),
            [OrderCut("p", float(example("response").ratio[0]), np.array([4000.0, 6000.0]), np.array([0.1, 0.2]))],
        ),
        "compare_time": record_beside_a_pair,
        "sensors": lambda: rg.sensors(model("geared_pair"), count=4, elements=1),
        "update": lambda: rg.update(model("jeffcott"), [20.0, 126.0], free="bearings.*.stiffness"),
        "scatter": lambda: rg.scatter(
            model("jeffcott"), "bearings.*.stiffness", samples=8, modes=4, elements=1, sobol=8
        ),
        "optimise": lambda: rg.optimise(
            model("jeffcott"), "shafts.*.sections.*.outer_diameter", searches=1, elements=2
        ),
        "rig_spectrum": lambda: rg.compare_spectrum(
            example("transient"), example("spectral_lines"), [rg.RigLine(2000.0)]
        ),
    }
    result: Result = made[kind]() if kind in made else getattr(rg, kind)(rotor)
    return result


KINDS = sorted(kinds())
each_kind = pytest.mark.parametrize("kind", KINDS)


def arrays_in(value: Any) -> list[np.ndarray]:
    """All arrays in a value, however deep."""
    if isinstance(value, np.ndarray):
        return [value]
    if isinstance(value, Record):
        return [found for item in fields(value) for found in arrays_in(getattr(value, item.name))]
    if isinstance(value, dict):
        return [found for entry in value.values() for found in arrays_in(entry)]
    if isinstance(value, tuple):
        return [found for entry in value for found in arrays_in(entry)]
    return []


@each_kind
def test_the_text_of_a_result_fits_on_a_screen_and_is_the_commands_table(kind: str) -> None:
    result = example(kind)
    shown = repr(result)
    lines = shown.splitlines()
    assert 1 < len(lines) <= 40
    assert "no table" not in lines[0]
    whole = result.text().splitlines()
    assert lines[:39] == whole[:39]
    assert len(whole) <= 40 or lines[-1].startswith(f"... and {len(whole) - 39} more")
    html = result._repr_html_()
    assert html.count("<table>") == html.count("</table>") == sum(isinstance(one, Table) for one in result.tables())
    assert html.startswith(("<p>", "<table>"))


def test_markup_in_names_is_shown_as_it_is() -> None:
    named = replace(example("spectral_lines"), name="<b>[red]x</b>")
    assert "&lt;b&gt;[red]x&lt;/b&gt;" in named._repr_html_()


def test_a_result_shows_its_table_in_a_notebook_and_nothing_beside_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("rich.console._is_jupyter", lambda: True)
    result = rg.check(model("jeffcott"))
    assert "input shaft 'rotor' at 1500 rpm" in result.text()
    assert "input shaft &#x27;rotor&#x27; at 1500 rpm" in result._repr_html_()
    assert capsys.readouterr().out == ""


@each_kind
def test_a_pickled_and_a_saved_copy_are_equal_and_a_changed_one_is_not(kind: str, tmp_path: Any) -> None:
    result = example(kind)
    assert pickle.loads(pickle.dumps(result)) == result
    save(result, tmp_path / "result.h5")
    assert read(tmp_path / "result.h5") == result
    assert replace(result, method="another") != result
    with pytest.raises(TypeError):
        hash(result)


@each_kind
def test_arrays_are_read_only_also_out_of_a_pickle(kind: str) -> None:
    for result in (example(kind), pickle.loads(pickle.dumps(example(kind)))):
        assert not any(array.flags.writeable for array in arrays_in(result))


@each_kind
def test_a_result_says_where_it_is_from(kind: str) -> None:
    result = example(kind)
    assert result.rotorgear_version == rg.__version__
    assert result.status == "success"
    assert result.seconds["total"] >= 0.0
    assert result.settings
    assert len(result.model_hash) == 64
    if isinstance(getattr(result, "model", None), rg.Model):
        assert result.model_hash == model_hash(result.model)  # type: ignore[attr-defined]


@each_kind
def test_what_is_written_is_declared(kind: str) -> None:
    data = json.loads(json.dumps(example(kind).to_dict(), allow_nan=False))
    declared = {path.partition(".")[0].removesuffix("[]").split("[")[0] for path, _, _ in keys_of(kinds()[kind])}
    assert set(data) == declared


@each_kind
def test_axes_say_the_shape_of_every_array_and_one_axis_has_one_length(kind: str) -> None:
    def check(record: Record) -> None:
        lengths: dict[str, int] = {}
        for item in fields(record):
            declared = record.declarations[item.name]  # every field is declared
            value = getattr(record, item.name)
            if isinstance(value, np.ndarray):
                assert len(declared.axes) == value.ndim, item.name
                for axis, length in zip(declared.axes, value.shape, strict=True):
                    assert lengths.setdefault(axis, length) == length, (item.name, axis)
            elif isinstance(value, Record):
                check(value)
            elif isinstance(value, tuple) and value and isinstance(value[0], Record):
                for entry in value:
                    check(entry)

    check(example(kind))


def test_one_name_means_one_thing_in_all_results() -> None:
    said: dict[str, tuple[str, str]] = {}
    for cls in kinds().values():
        for name, declared in cls.declarations.items():
            if declared.record is None and name not in HOMONYMS:
                words = (declared.label, declared.unit)
                assert said.setdefault(name, words) == words, f"{cls.__name__}.{name}"


def test_every_field_has_a_label() -> None:
    kinds()
    for cls in Record.known.values():
        for item in fields(cls):
            assert cls.declarations[item.name].label, f"{cls.__name__}.{item.name}"


def test_rows_of_modes_and_of_records_are_flat_and_plain() -> None:
    rows = example("modal").rows("mode")
    assert [row["mode"] for row in rows] == [1, 2, 3, 4]
    assert rows[2]["frequency_hz"] == pytest.approx(example("modal").frequency_hz[2])  # type: ignore[attr-defined]
    assert type(rows[0]["damping_ratio"]) is float
    assert "kinetic_by_motion.bending" in rows[0]
    shares = example("campbell").rows("lines")
    assert set(shares[0]) >= {"name", "order"}
    pairs = example("campbell").rows("speed", "branch")
    assert len(pairs) == len(example("campbell").eigenvalues.ravel())  # type: ignore[attr-defined]
    with pytest.raises(rg.AnalysisError, match=r"got 'modes', expected one of .*mode"):
        example("modal").rows("modes")


def test_a_data_set_has_names_units_and_the_origin() -> None:
    pytest.importorskip("xarray")
    data = example("modal").to_xarray()
    assert data["frequency_hz"].dims == ("mode",)
    assert data["frequency_hz"].attrs == {"long_name": "frequency", "units": "Hz"}
    assert data.attrs["model_hash"] == example("modal").model_hash
    assert "bending" in data["kinetic_by_motion"]["motion"].values
    assert list(data["shapes"].sel(component="tilt_x").dims) == ["node", "mode"]
    assert list(data["mode"].values) == [row["mode"] for row in example("modal").rows("mode")]
    assert data["frequency_hz"].sel(mode=2) == example("modal").frequency_hz[1]  # type: ignore[attr-defined]
    response = example("frf")
    assert response.to_xarray()["receptance"]["frequency"].attrs["units"] == "Hz"


@each_kind
def test_every_dimension_of_a_data_set_has_coordinates(kind: str) -> None:
    pytest.importorskip("xarray")
    data = example(kind).to_xarray()
    assert set(data.sizes) <= set(data.coords)


def test_a_field_appears_everywhere_from_one_line(tmp_path: Any) -> None:
    class Toy(SpectralLines, kind="toy"):
        phase: np.ndarray = of(
            "phase", "rad", "line", json="phase_deg", default_factory=lambda: np.zeros(2), kw_only=True
        )

    try:
        toy = Toy(
            "x", "m", np.array([1.0, 2.0]), np.array([3.0, 4.0]), ("", ""), "hann", 0.1, phase=np.array([0.0, np.pi])
        )
        assert [line["phase_deg"] for line in toy.to_dict()["lines"]] == [0.0, 180.0]
        assert ("lines[].phase_deg", "deg", "phase") in list(keys_of(Toy))
        assert "phase_deg" not in SpectralLines.declarations["lines"].record.declarations  # type: ignore[union-attr]
        assert toy.rows("line")[1]["phase"] == pytest.approx(np.pi)
        assert not toy.phase.flags.writeable
        assert replace(toy, phase=np.array([0.0, 1.0])) != toy
    finally:
        del Result.kinds["toy"], Record.known["Toy"]


def test_a_result_of_declared_fields_has_its_tables_and_a_label_is_said_once() -> None:
    class Wear(Record):
        part: str = of("worn part", column="part")
        depth: float = of("depth of wear", "m", form=".1f", column="deep um")

    class Trial(Result, kind="trial"):
        spots: tuple[Wear, ...] = of("worn spots", "", "spot", record=Wear)
        heat: np.ndarray = of("temperature", "K", "place", form=".0f", column="K")

    try:
        trial = Trial(spots=(Wear("gears.a", 2e-6),), heat=np.array([300.0, 310.0]))
        text = trial.text()
        assert "part     deep um" in text
        assert "gears.a      2.0" in text
        assert "310" in text
        html = trial._repr_html_()
        assert '<th scope="col" class=number>depth of wear, um</th>' in html
        spots = next(one for one in trial.tables() if isinstance(one, Table) and one.caption == "Worn spots")
        assert 'data-key="/trial/spots/0/depth_m"' in html_table(spots, top=("trial",))
        assert trial.to_dict()["spots"] == [{"part": "gears.a", "depth_m": 2e-6}]
        assert ("spots[].depth_m", "m", "depth of wear") in list(keys_of(Trial))
        assert trial.rows("spots") == [{"part": "gears.a", "depth": 2e-6}]
    finally:
        for name in ("Wear", "Trial"):
            Record.known = {known: cls for known, cls in Record.known.items() if cls.__name__ != name}
        del Result.kinds["trial"]


def test_the_terminal_and_the_page_write_a_number_alike() -> None:
    assert [written(value, ".1f") for value in (None, -0.0, float("nan"), -0.04, float("inf"))] == [
        "-",
        "0.0",
        "-",
        "0.0",
        "-",
    ]
    assert [error_words(value) for value in (0.0, 1e-23, 2e-9, 0.011)] == ["<1e-9", "<1e-9", "2e-09", "1e-02"]
    assert [exact(".4f")(value) for value in (3.2e-5, -3e-6, 1e-12, 0.0, 12.5)] == [
        "3e-05",
        "-3e-06",
        "0.0000",
        "0.0000",
        "12.5000",
    ]


def test_no_declared_error_or_residual_is_written_as_a_power_of_ten_of_rounding() -> None:
    kinds()
    declared = [one for cls in Record.known.values() for one in cls.declarations.values()]
    small = [
        one for one in declared if one.form and one.name.endswith(("error_estimate", "residual", "reduction_error"))
    ]
    assert len({one.name for one in small}) == 3
    assert {written(value, one.form) for one in small for value in (0.0, 1e-23)} == {"<1e-9"}


def test_a_changed_value_changes_the_hash_of_a_model_and_the_order_of_its_tables_does_not() -> None:
    rotor = model("jeffcott")
    same = rg.Model(**dict(reversed(rotor.model_dump(exclude_none=True).items())))
    assert model_hash(same) == model_hash(rotor)
    assert model_hash(rotor.model_copy(update={"title": "another"})) != model_hash(rotor)
    # Tables are not frozen as parts are.
    name = next(iter(same.shafts))
    same.shafts[name] = same.shafts[name].model_copy(update={"internal_damping": None, "position": (0.5, 0.5)})
    assert model_hash(same) != model_hash(rotor)
