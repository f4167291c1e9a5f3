"""The page of keys of the site names every key that the commands write as JSON, and no other."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from machinery.json_keys import SECTIONS
from machinery.snippets import ROOT
from typer.testing import CliRunner
from update import load_generator

from rotorgear.analysis.static.static import static
from rotorgear.cli.main import app
from rotorgear.model.load import load
from rotorgear.results.kinds import kinds
from tests.models import pair_file
from tests.unit.analysis.static.test_bearing_states import rotor
from tests.unit.casings.blocks import block, write_inp

MODEL = ROOT / "models" / "split_torque.toml"
# At this speed two modes are near the second mesh order of stage 2: one is matched, one is not. The shaft order of the output
# is far from all modes. One line lies between two modes, with every column filled in.
SPEED = "15000 rpm"
RIG = """frequency_hz,label,uncertainty_hz,damping_ratio
13.34,output shaft,,
828.6,ambiguous,3,0.01
3336,mesh of stage 2,,
"""


@cache
def whole_page() -> str:
    """The page of the site."""
    return str(load_generator(ROOT / "docs" / "generate_commands.py").site_pages()["docs/commands.md"])


def documented(section: str) -> set[str]:
    """Return the keys of a section's table."""
    part = re.split(r"\n##+ ", whole_page().split(f"\n### JSON of {section}\n")[1])[0]
    return set(re.findall(r"^\| `([^`]+)` \|", part, flags=re.MULTILINE))


def keys(value: Any, path: str = "") -> Iterator[str]:
    """Yield the path of everything that is no table itself, lists marked by [], and of what may be null."""
    if isinstance(value, dict):
        for key, inner in (value or {"no_name": None}).items():
            yield from keys(inner, f"{path}.{key}" if path else key)
    elif isinstance(value, list):
        yield from ([f"{path}[]"] if not value else (key for item in value for key in keys(item, f"{path}[]")))
    else:
        yield path


def holds(path: str, listed: set[str]) -> bool:
    """Whether a path is that of a table or a list of tables, which may be null or empty."""
    return any(other.startswith((f"{path}.", f"{path}[].")) for other in listed)


def pattern(path: str) -> re.Pattern[str]:
    """A documented path in which each word in capitals stands for any name, dots included."""
    return re.compile(re.sub(r"(?<=\.)[A-Z]+(?=\\|$)", ".+", re.escape(path)))


# What a result has only where there is something to say, in any result and in those inside of it.
SOMETIMES = re.compile(r"(.+\.)?(left_out|warnings|facts|laws)\[\].*")


def differences(data: dict[str, Any], listed: set[str]) -> tuple[list[str], list[str]]:
    """Paths that are written and not listed, and those listed that are not written."""
    found = set(keys(data))
    patterns = {path: pattern(path) for path in listed}
    unlisted = [p for p in found if not holds(p, listed) and not any(one.fullmatch(p) for one in patterns.values())]
    unwritten = [
        p
        for p, one in patterns.items()
        if not (holds(p, listed) or SOMETIMES.fullmatch(p) or any(map(one.fullmatch, found)))
    ]
    return sorted(unlisted), sorted(unwritten)


NONE: tuple[list[str], list[str]] = ([], [])


PLANETARY = str(ROOT / "models" / "planetary.toml")
OF_PLANETS = ("mode_class", "class_energy", "carrier_frequency_hz", "carrier_frequency_share")


def written(tmp_path: Path, *arguments: str) -> dict[str, Any]:
    """Run a command with --json and return what it wrote."""
    target = tmp_path / "result.json"
    run = CliRunner().invoke(app, [*arguments, "--json", str(target)])
    assert run.exit_code == 0, run.output
    return dict(json.loads(target.read_text(encoding="utf-8")))


@pytest.fixture
def rig(tmp_path: Path) -> str:
    file = tmp_path / "rig.csv"
    file.write_text(RIG, encoding="utf-8")
    return str(file)


def test_the_keys_of_modal_and_of_its_comparison_are_documented(tmp_path: Path, rig: str) -> None:
    data = written(tmp_path, "modal", str(MODEL), "--speed", SPEED, "--fmax", "5000", "--compare", rig)
    comparison = data.pop("comparison")
    stage = written(tmp_path, "modal", PLANETARY, "--speed", "1800 rpm", "--modes", "2")
    data |= {key: stage[key] for key in OF_PLANETS}  # this model has no planets
    assert differences(data, documented("modal")) == NONE
    assert differences(comparison, documented("compare")) == NONE


def test_the_keys_of_compare_are_documented(tmp_path: Path, rig: str) -> None:
    data = written(tmp_path, "compare", str(MODEL), rig, "--speed", SPEED)
    assert differences(data, documented("compare")) == NONE


def test_the_keys_of_check_are_documented(tmp_path: Path) -> None:
    assert differences(written(tmp_path, "check", str(MODEL)), documented("check")) == NONE


def test_the_keys_of_transient_are_documented(tmp_path: Path, rig: str) -> None:
    name = "points.output_bearing_y acceleration"
    run = ["--modal-damping", "0.02", "--steps", "40", "--time", "2 ms", "--spectrum", name, "--rig", rig]
    assert differences(written(tmp_path, "transient", str(MODEL), *run), documented("transient")) == NONE


def test_the_keys_of_orbits_are_documented(tmp_path: Path) -> None:
    pair = str(ROOT / "models" / "backlash_pair.toml")
    data = written(tmp_path, "orbits", pair, "--over", "operation.speed=4000 rpm:4200 rpm", "--step", "0.5", "--verify")
    # The bearings of this pair are linear: no displacement is watched but that of the mesh.
    data |= {
        "place": ["bearings.front x"],
        "place_unit": ["m"],
        "place_extremes": [[[0.0, 1.0]]],
        "place_peak_to_peak": [[1.0]],
        # Nor does a point read a load.
        "load_points": ["torque"],
        "load_unit": ["N m"],
        "load_statistics": [[[0.0]]],
        "load_error": [[[0.0]]],
    }
    extremes = {"approach_extremes_m": [[0.0, 1.0]], "place_extremes": [[0.0, 1.0]]}
    point = {"kind": "fold", "value": 1.0, "branch": 0, "period_s": 1.0, "multiplier_real": [1.0]}
    data["special_points"] = [point | {"multiplier_imaginary": [0.0]} | extremes]
    curve = {"kind": "fold", "branch": 0, "value": [1.0], "second": [1.0], "period_s": [1.0], "ended": "the end"}
    data["curves"] = [curve | {name: [value] for name, value in extremes.items()}]  # of two parameters
    assert differences(data, documented("orbits")) == NONE


def test_the_keys_of_sweep_are_documented(tmp_path: Path) -> None:
    flexible = str(ROOT / "models" / "flexible_pair.toml")
    data = written(
        tmp_path,
        "sweep",
        flexible,
        "--over",
        "operation.speed=8000 rpm",
        "--discard",
        "9",
        "--sample",
        "9",
        "--portraits",
        "8000",
    )
    for point in data["points"]:
        for run in point["runs"]:
            # No point of this pair reads a load.
            run |= {"load_statistics": [[0.0]], "load_error": [[0.0]]}
    assert differences(data, documented("sweep")) == NONE


@pytest.mark.long  # a study is many sweeps
def test_the_keys_of_the_convergence_study_of_a_sweep_are_documented(tmp_path: Path) -> None:
    pair = str(ROOT / "models" / "backlash_pair.toml")
    assert differences(written(tmp_path, "accuracy", pair, "--analysis", "sweep"), documented("sweep accuracy")) == NONE


def test_the_keys_of_gear_are_documented(tmp_path: Path) -> None:
    assert differences(written(tmp_path, "gear", str(MODEL)), documented("gear")) == NONE


def test_the_keys_of_casing_are_documented(tmp_path: Path) -> None:
    pytest.importorskip("meshio")
    write_inp(tmp_path / "box.inp", block(kind="tetra"))
    shaft = 'position = [0.05, 0.03]\nstart = 0.2\nsections = [{ length = "1 m", outer_diameter = "20 mm" }]'
    casing = 'mesh = "box.inp"\nunit = "m"\nmaterial = "steel"\nheld = ["low"]\nseats = { left = "high" }'
    bearing = 'shaft = "a"\nat = "start"\nstiffness = { radial = 1e8 }\ncasing = "box"'
    text = f"[shafts.a]\n{shaft}\n[casings.box]\n{casing}\n[bearings.left]\n{bearing}\n"
    (tmp_path / "box.toml").write_text(text)
    found = written(tmp_path, "casing", str(tmp_path / "box.toml"), "--modes", "2")
    assert differences(found, documented("casing")) == NONE


def test_the_keys_of_accuracy_are_documented(tmp_path: Path) -> None:
    chain = ROOT / "models" / "torsion_chain.toml"
    assert differences(written(tmp_path, "accuracy", str(chain)), documented("accuracy")) == NONE


def test_the_keys_of_mesh_are_documented(tmp_path: Path) -> None:
    file = tmp_path / "pair.toml"
    file.write_text(pair_file(mesh='stiffness = "tooth_fe"\ntooth_fe = { preset = "preview" }'), encoding="utf-8")
    data = written(tmp_path, "mesh", str(file), "--load-factors", "0.5")
    data["slice_errors"] = data["element_errors"]  # spur teeth have none
    assert differences(data, documented("mesh")) == NONE
    study = written(tmp_path, "accuracy", str(file), "--analysis", "mesh")
    assert differences(study, documented("mesh accuracy")) == NONE


def test_the_keys_of_campbell_are_documented(tmp_path: Path) -> None:
    data = written(tmp_path, "campbell", str(MODEL), "--points", "3", "--elements", "1", "--modes", "8")
    data["onsets"] = [{"branch": 1, "speed_rpm": 1.0, "frequency_hz": 1.0}]  # nothing in it is unstable
    stage = written(tmp_path, "campbell", PLANETARY, "--points", "2", "--elements", "1", "--modes", "2")
    data |= {key: stage[key] for key in OF_PLANETS}  # nor has it planets
    assert differences(data, documented("campbell")) == NONE


def test_the_keys_of_critical_are_documented(tmp_path: Path) -> None:
    jeffcott = ROOT / "models" / "jeffcott.toml"
    data = written(tmp_path, "critical", str(jeffcott), "--to", "3000 rpm", "--map", "--elements", "2")
    assert differences(data, documented("critical")) == NONE


def test_the_keys_of_static_are_documented(tmp_path: Path) -> None:
    data = written(tmp_path, "static", str(MODEL))
    data["faces"] = written(tmp_path, "static", str(ROOT / "models" / "overhung_pinion.toml"))["faces"]  # nor any
    data["casing_force_n"] = data["casing_moment_n_m"] = {"box": [0.0, 0.0, 0.0]}  # nor a casing
    for part, place in (("casing_ground", "feet"), ("casing_seat", "left")):
        data[f"{part}_force_n"] = data[f"{part}_moment_n_m"] = {"box": {place: [0.0, 0.0, 0.0]}}
    bearing = rotor('kind = "ball", elements = 7, element_diameter = 0.01, pitch_diameter = 0.04', "[9.0, 0.0, 0.0]")
    read = load(MODEL).with_("points.torque", {"on": "gears.bull", "quantity": "torque"})
    data |= {"rigid_mesh": ["stage_1a"], "rigid_mesh_force_n": [1.0]}  # nor a rigid mesh
    data["internal_loads"] = static(read).to_dict()["internal_loads"]
    data |= {key: static(bearing).to_dict()[key] for key in ("laws", "load_force_n", "load_moment_n_m")}  # nor these
    assert differences(data, documented("static")) == NONE


def test_the_keys_of_response_are_documented(tmp_path: Path) -> None:
    (tmp_path / "limits.csv").write_text("at,speed_rpm,amplitude_N\nstage_1a,0,500\nstage_1a,30000,500\n")
    asked = ("--points", "2", "--fmax", "3000", "--elements", "1", "--limits", str(tmp_path / "limits.csv"))
    data = written(tmp_path, "response", str(MODEL), *asked)
    data["internal_load"] = {"meter": [[0.0]]}  # nor a point that reads a load
    data["normal_velocity_m_per_s"] = data["radiated_power_w"] = {"box": [[0.0]]}  # this model has no casing
    for part, place in (("casing_ground", "feet"), ("casing_seat", "left")):
        for kind in ("force_n", "moment_n_m"):
            data[f"{part}_{kind}"] = {"box": {place: {axis: [[0.0]] for axis in "xyz"}}}
    assert differences(data, documented("response")) == NONE


def test_the_keys_of_frf_are_documented(tmp_path: Path) -> None:
    places = ("--inputs", "gears.bull:y", "--outputs", "output_bearing_y")
    data = written(tmp_path, "frf", str(MODEL), *places, "--fmax", "50", "--points", "3", "--elements", "1")
    assert differences(data, documented("frf")) == NONE


def test_every_output_stands_below_a_command_of_the_page() -> None:
    below = re.findall(r"^### JSON of (.+)$", whole_page(), flags=re.MULTILINE)
    assert sorted(below) == sorted(heading for heading, _, _ in SECTIONS)
    assert {kind for _, _, parts in SECTIONS for kind, _ in parts} == set(kinds())


def test_a_key_that_is_not_in_the_table_is_found() -> None:
    listed = {"a[].b", "steps.STEP", "part.NAME.x[]", "d", "d.e", "gone"}
    data = {"a": [{"b": 1}, {"c": None}], "steps": {"x": 1.0}, "part": {"gears.pinion": {"x": [1.0]}}, "d": None}
    assert differences(data, listed) == (["a[].c"], ["d.e", "gone"])
