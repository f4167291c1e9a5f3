"""All linear analyses are about one state: the mean of all loaded teeth in equilibrium together over the mesh cycle."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import rotorgear as rg
from rotorgear.analysis.static.state_at import state_at
from tests.models import pair_file

PREVIEW = 'stiffness = "tooth_fe"\ntooth_fe = { preset = "preview" }'


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory) -> rg.Model:
    """A herringbone pair whose shafts turn off axis under the thrust, so that its helices carry unlike shares."""
    path: Path = tmp_path_factory.mktemp("pair") / "pair.toml"
    path.write_text(pair_file(helix=25.0, kind="herringbone", mesh=PREVIEW, torque="3000 N m"))
    return rg.load(path).with_(
        {"bearings.one_end.stiffness.radial": "1e8 N/m", "gears.wheel.at": "152 mm", "gears.pinion.at": "150 mm"}
    )


def taken(sentences: tuple[str, ...]) -> float:
    """The stiffness that an analysis says it takes, in N/m."""
    return float(re.search(r"% of (\S+) N/m", " ".join(sentences))[1])  # type: ignore[index]


def test_all_analyses_take_the_same_mean_tangent(pair: rg.Model) -> None:
    static = rg.static(pair, elements=1)
    expected = static.mesh_stiffness.sum()
    response = rg.response(pair, points=2, elements=1, fmax=800.0)
    assert response.mesh_stiffness == pytest.approx(static.mesh_stiffness, rel=1e-9)
    said = {
        "modal": rg.modal(pair, modes=8, elements=1).left_out,
        "campbell": rg.campbell(pair, points=2, modes=8, elements=1).left_out,
        "critical": rg.critical(pair, fmax=300.0, elements=1).left_out,
        "frf": rg.frf(pair, [100.0], inputs=["gears.pinion:x"], outputs=["gears.pinion:x"], elements=1).left_out,
    }
    assert {name: taken(sentences) for name, sentences in said.items()} == pytest.approx(
        dict.fromkeys(said, expected), rel=1e-3
    )


def test_helices_that_carry_unlike_shares_have_stiffnesses_of_their_own(pair: rg.Model) -> None:
    flow = pair.torque_flow(1).forces
    settled = state_at(pair, [None]).forces
    assert flow[0].contact.stiffness == pytest.approx(flow[1].contact.stiffness, rel=1e-9)
    heavy = 0 if settled[0].normal_force > settled[1].normal_force else 1
    assert settled[heavy].contact.stiffness > 1.003 * settled[1 - heavy].contact.stiffness


@pytest.mark.long  # flexibilities of a wheel with a web
def test_a_mesh_between_held_shafts_has_the_tangent_of_the_torque_flow(tmp_path: Path) -> None:
    path = tmp_path / "pair.toml"
    path.write_text(pair_file(mesh=PREVIEW, torque="300 N m"))
    held = {"shaft": "one", "at": "150 mm", "fixed": ["torsion"]}
    supports = {"pinion": held, "wheel": {**held, "shaft": "two"}}
    # A web at the end of the face lets the rim tilt, so that light contacts touch there only.
    web = {"rim_thickness": "8 mm", "web_thickness": "4 mm", "web_position": "6 mm"}
    model = rg.load(path).with_({"motions": ["torsion"], "supports": supports, "gears.wheel.body": web})
    expected = model.torque_flow(1).forces[0].contact.stiffness
    assert state_at(model, [None]).forces[0].contact.stiffness == pytest.approx(expected, rel=1e-9)
