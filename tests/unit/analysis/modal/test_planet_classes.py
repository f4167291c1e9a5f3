"""Classes of planetary modes: counts, closed forms, the frame of the carrier, and modes of several classes."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg as la

import rotorgear as rg
from rotorgear.system.system import flow_system
from tests.planetary import GROUND, PIN, Springs, helical_stage, in_frame_of_the_carrier, springs, torsional_train

# Planets and the teeth of sun, planet and ring.
FOUR = (4, (26, 36, 98))
FIVE = (5, (24, 26, 76))


def shares_of_a_stage(found: rg.ModalResult) -> np.ndarray:
    """Shares (3, m) of the classes: rotational, translational, planet."""
    return np.array([found.class_energy[f"stage {name}"] for name in ("rotational", "translational", "planet")])


@pytest.mark.parametrize(("planets", "teeth"), [FOUR, FIVE])
def test_a_helical_stage_at_rest_has_as_many_modes_of_each_class_as_its_symmetry_asks_for(
    planets: int, teeth: tuple[int, int, int]
) -> None:
    """Of three central bodies and one planet: 2 and 6 coordinates of k = 0, 4 and 6 of each of k = +-1, 6 of each further k."""
    found = rg.modal(rg.loads(helical_stage(planets, teeth=teeth)), modes=6 * (3 + planets))
    shares = shares_of_a_stage(found)
    assert shares.sum(axis=0) == pytest.approx(np.ones(len(found)), abs=1e-9)
    assert np.max(shares, axis=0) == pytest.approx(np.ones(len(found)), abs=1e-9)
    count = {name: found.mode_class.count(name) for name in set(found.mode_class)}
    assert count == {"rotational-axial": 12, "translational-tilting": 24, "planet": 6 * (planets - 3)}
    pairs = np.sort(found.frequency_hz[np.array(found.mode_class) == "translational-tilting"]).reshape(-1, 2)
    assert pairs[:, 0] == pytest.approx(pairs[:, 1], rel=1e-8)


def test_modes_of_planets_alone_are_those_of_one_planet_between_bodies_at_rest() -> None:
    planets, teeth = FIVE
    model = rg.loads(helical_stage(planets, teeth=teeth))
    system = flow_system(model)
    own = 6 * system.nodes.at("planet#3", 0.0) + np.arange(6)
    here = np.ix_(own, own)
    held = np.sqrt(la.eigh(system.stiffness(0.0).toarray()[here], system.mass.toarray()[here])[0]) / (2.0 * np.pi)
    found = rg.modal(model, modes=6 * (3 + planets))
    alone = np.array(found.mode_class) == "planet"
    assert found.frequency_hz[alone] == pytest.approx(np.repeat(held, planets - 3), rel=1e-8)
    still = [k for k, shaft in enumerate(found.nodes.shaft) if "#" not in shaft]
    largest = np.abs(found.shapes).max(axis=(0, 1))
    assert np.all(np.abs(found.shapes[still]).max(axis=(0, 1))[alone] < 1e-6 * largest[alone])


@pytest.mark.parametrize(("planets", "teeth"), [FOUR, FIVE])
@pytest.mark.parametrize("W", [310.0, -170.0])
def test_frequencies_in_the_frame_of_the_carrier_are_those_of_matrices_in_that_frame(
    planets: int, teeth: tuple[int, int, int], W: float
) -> None:
    model = rg.loads(helical_stage(planets, teeth=teeth))
    system = flow_system(model)
    found = rg.modal(model, speed=W / system.train.ratio("carrier"), modes=6 * (3 + planets))
    own = in_frame_of_the_carrier(system, W) / (2.0 * np.pi)
    told = found.carrier_frequency_hz["stage"]
    assert np.sort(told)[1:] == pytest.approx(own, rel=1e-7)
    assert found.carrier_frequency_share["stage"] == pytest.approx(np.ones(len(found)), abs=1e-9)
    moved = np.array(found.mode_class) == "translational-tilting"
    assert np.count_nonzero(moved) == 24
    assert told[~moved] == pytest.approx(found.frequency_hz[~moved], abs=0.0)
    # Each sense goes with half of the pairs, whichever way the carrier turns.
    shift = 2.0 * np.pi * (told - found.frequency_hz)[moved] / W
    assert np.sort(shift) == pytest.approx(np.repeat([-1.0, 1.0], 12), abs=1e-9)


def test_bearings_with_preferred_directions_show_a_carrier_two_frequencies_of_one_mode() -> None:
    """They couple both senses of translations, and nothing with the other classes."""
    ground: dict[str, Springs] = {name: {**values, "y": 2.5 * values["y"]} for name, values in GROUND.items()}
    planets, teeth = FOUR
    model = rg.loads(helical_stage(planets, teeth=teeth, ground=ground))
    found = rg.modal(model, speed="3000 rpm", modes=24)
    assert set(found.mode_class) == {"rotational-axial", "translational-tilting", "planet"}
    share = found.carrier_frequency_share["stage"]
    pairs = np.array(found.mode_class) == "translational-tilting"
    assert np.all(share[~pairs] > 1.0 - 1e-9)
    assert np.all((share[pairs] > 0.5) & (share[pairs] < 1.0 - 1e-6))
    assert share[pairs].min() < 0.95
    table = found.text(width=120)
    least = int(np.argmin(share))
    assert f"{found.carrier_frequency_hz['stage'][least]:.4f}, {100.0 * share[least]:.0f} %" in table


def test_a_planet_that_differs_mixes_classes_and_each_has_its_share() -> None:
    """Shares by an own sum over the planets, which are points: class 0 has the mean of their displacements."""
    planets, teeth = FIVE
    more = f'[bearings."pin#2"]\nstiffness = {springs({name: 0.4 * value for name, value in PIN.items()})}'
    model = rg.loads(helical_stage(planets, teeth=teeth, more=more))
    found = rg.modal(model, modes=20)
    shares = shares_of_a_stage(found)
    assert shares.sum(axis=0) == pytest.approx(np.ones(20), abs=1e-9)
    system = flow_system(model)
    M = system.mass.toarray()
    own = [6 * system.nodes.at(f"planet#{k + 1}", 0.0) + np.arange(6) for k in range(planets)]
    node = {name: 6 * system.nodes.at(name, 0.0) for name in ("sun", "ring", "carrier")}
    order = [found.nodes.shaft.index(name) for name in system.nodes.shaft]
    q = found.shapes[order].reshape(-1, 20).real
    rotational = np.zeros(20)
    for dofs in ([first + k for k in (2, 5)] for first in node.values()):
        rotational += np.einsum("dm,de,em->m", q[dofs], M[np.ix_(dofs, dofs)], q[dofs])
    mean = np.mean([q[dofs] for dofs in own], axis=0)
    rotational += planets * np.einsum("dm,de,em->m", mean, M[np.ix_(own[0], own[0])], mean)
    whole = np.einsum("dm,de,em->m", q, M, q)
    assert shares[0] == pytest.approx(rotational / whole, abs=1e-9)
    mixed = int(np.argmin(shares.max(axis=0)))
    assert shares[:, mixed].max() < 0.9
    assert found.mode_class[mixed].count(" %") >= 2
    assert f"{100.0 * shares[:, mixed].max():.0f} %" in found.mode_class[mixed]


def test_modes_of_one_frequency_are_told_class_by_class() -> None:
    """Planets of a spur stage slide on pins whose carrier does not move along the axis: one frequency for all classes."""
    planets, teeth = FOUR
    fixed = '[supports.still]\nshaft = "carrier"\nat = 0\nfixed = ["z", "tilt_x", "tilt_y"]'
    text = helical_stage(planets, teeth=teeth, pin={**PIN, "axial": 3e7}, more=fixed)
    spur = text.replace('kind = "helical"', 'kind = "spur"').replace('helix_angle = "20 deg"\n', "")
    for hand in ("right", "left"):
        spur = spur.replace(f'hand = "{hand}"\n', "")
    model = rg.loads(spur)
    found = rg.modal(model, modes=18)
    slide = np.flatnonzero(np.abs(found.frequency_hz - np.sqrt(3e7 / 2.2) / (2.0 * np.pi)) < 1e-4)
    assert sorted(found.mode_class[k] for k in slide) == ["axial", "planet", "tilting", "tilting"]
    assert np.max(shares_of_a_stage(found)[:, slide], axis=0) == pytest.approx(np.ones(4), abs=1e-9)
    # They are modes all the same, of modal mass 1 and apart from each other.
    z = np.array([found.shapes[k, 2, slide].real for k, name in enumerate(found.nodes.shaft) if "#" in name])
    assert 2.2 * z.T @ z == pytest.approx(np.eye(4), abs=1e-7)


def test_in_torsion_alone_nothing_follows_translations() -> None:
    model = torsional_train(
        "sun",
        "sun ring carrier",
        "sun sun 24, planet planet 26, ring ring -76",
        "sun planet, planet ring",
        "stage carrier 5",
        "planet stage",
        given="ring 0",
        loads="carrier",
    )
    found = rg.modal(model, modes=6)
    assert sorted(found.mode_class) == ["planet"] * 4 + ["rotational"] * 2


def test_a_model_without_planets_has_no_classes() -> None:
    found = rg.modal(rg.load("models/geared_pair.toml"), modes=3)
    assert found.mode_class == ()
    assert found.class_energy == {}
    assert "class" not in found.text()


def test_rows_and_json_hold_the_classes() -> None:
    model = rg.loads(helical_stage(FOUR[0], teeth=FOUR[1]))
    found = rg.modal(model, speed="2000 rpm", modes=9)
    row = found.rows("mode")[3]
    assert row["mode_class"] == found.mode_class[3]
    assert row["class_energy.stage translational"] == found.class_energy["stage translational"][3]
    assert row["carrier_frequency_hz.stage"] == found.carrier_frequency_hz["stage"][3]
    written = found.to_dict()
    assert written["mode_class"] == list(found.mode_class)
    assert written["carrier_frequency_hz"]["stage"][3] == row["carrier_frequency_hz.stage"]


def test_branches_of_a_campbell_diagram_have_the_classes_of_their_modes_at_each_speed() -> None:
    planets, teeth = FOUR
    model = rg.loads(helical_stage(planets, teeth=teeth))
    system = flow_system(model)
    count = 6 * (3 + planets)
    carrier = np.array([-290.0, -310.0])
    speeds = list(carrier / system.train.ratio("carrier"))
    diagram = rg.campbell(model, speeds=speeds, modes=count, shaft_orders=(), mesh_orders=(), error_estimate=False)
    assert len(diagram) == count - 1  # without the rotation of the train
    for k, W in enumerate(carrier):
        told = diagram.carrier_frequency_hz["stage"][k]
        assert np.sort(told) == pytest.approx(in_frame_of_the_carrier(system, W) / (2.0 * np.pi), rel=1e-7)
        moved = ~np.isclose(told, diagram.frequency_hz[k], rtol=1e-9, atol=0.0)
        shares = {name: diagram.class_energy[f"stage {name}"][k] for name in ("rotational", "translational", "planet")}
        assert shares["translational"] == pytest.approx(moved.astype(float), abs=1e-9)
        assert sum(shares.values()) == pytest.approx(np.ones(len(diagram)), abs=1e-9)
    classes = np.array(diagram.mode_class)
    assert np.array_equal(classes == "translational-tilting", moved)
    assert np.count_nonzero(classes == "planet") == 6 * (planets - 3)
    assert "from stage Hz" in diagram.text()
