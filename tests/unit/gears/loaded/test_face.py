"""A face of loaded teeth: what it answers to force and tilt, against difference quotients and its own slices."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rotorgear.gears.loaded.face import load_per_width, loaded_face
from rotorgear.gears.loaded.helix_cycles import helix_cycle
from rotorgear.gears.loaded.loaded_contact import solve_contact
from rotorgear.gears.loaded.mesh_cycle import MeshCycle, loaded_cycle
from rotorgear.gears.tooth_fe.settings import ToothFe
from rotorgear.model.layout.mesh_layout import mirrored
from tests.unit.gears.tooth_pairs import LOAD, WIDTH, cycle, helical, pair

POSITIONS = 16
# In space and coupled; slices along the face of a spur pair that don't feel each other.
PAIRS = {"helical": helical(misalignment=60e-6), "spur": pair(fe=ToothFe(preset="preview"), misalignment=20e-6)}


def _pressed(found: MeshCycle, force: float) -> tuple[float, float]:
    """Mean approach and moment of the contacts of a cycle under another force along the normal."""
    place = found.slices.z @ found.slices.weight
    states = [solve_contact(contact, force) for contact in found.contacts]
    moments = [state.force @ place[found.slices.at(i)] for i, state in enumerate(states)]
    return float(found.weight @ [state.approach for state in states]), float(found.weight @ moments)


# The coarse slices of the helical pair come off one at a time; within 1 um its patches change their width.
@pytest.mark.parametrize(("name", "step", "near"), [("helical", 3e-7, 0.01), ("spur", 1e-6, 5e-3)])
def test_static_springs_are_the_slopes_of_mean_deflection_and_moment(name: str, step: float, near: float) -> None:
    teeth = PAIRS[name]
    face = loaded_face(teeth, LOAD, POSITIONS)
    # The same slices and patches under a little more and less: at each load of their own they would be cut anew.
    contacts = helix_cycle(teeth, LOAD * np.cos(teeth.pair.base_helix_angle), POSITIONS).cycle
    h = 1e-3
    more, less = (_pressed(contacts, LOAD * (1.0 + s)) for s in (h, -h))
    dF = 2.0 * h * LOAD
    assert (more[0] - less[0]) / dF == pytest.approx(1.0 / face.static.stiffness, rel=1e-3)
    assert (more[1] - less[1]) / dF == pytest.approx(face.static.place, rel=5e-3)

    positions = contacts.position

    def means(misalignment: float) -> np.ndarray:
        """Approach along the normal and moment, straight between the same positions: chosen anew, they would differ a little."""
        cosine = np.cos(teeth.pair.base_helix_angle)
        askew = replace(teeth, misalignment=misalignment)
        found = loaded_cycle(askew, LOAD * cosine, positions)[1]
        return np.array([cosine * found.weight @ found.deflection, found.weight @ found.moment])

    approach, moment = means(teeth.misalignment + step) - means(teeth.misalignment - step)
    # At a constant load: ddelta = -e dtilt, dM = k_t dtilt, and a misalignment is less tilt.
    tilt = -2.0 * step / WIDTH
    assert approach / tilt == pytest.approx(-face.static.place, rel=near)
    assert moment / tilt == pytest.approx(face.static.tilt_stiffness, rel=near)


def test_slices_that_do_not_feel_each_other_resist_a_tilt_like_a_line_of_springs() -> None:
    teeth = pair(fe=ToothFe(preset="preview"), tilts=True)
    face = loaded_face(teeth, LOAD, POSITIONS)
    assert face.dynamic.tilt_stiffness == pytest.approx(face.dynamic.stiffness * WIDTH**2 / 12.0, rel=1e-3)
    assert face.load_factor == pytest.approx(1.0, rel=1e-9)
    assert face.moment == pytest.approx(0.0, abs=1e-9 * LOAD * WIDTH)


def test_dynamic_stiffness_is_the_mean_tangent_of_the_curve() -> None:
    teeth = PAIRS["helical"]
    found = cycle(teeth, LOAD * np.cos(teeth.pair.base_helix_angle), POSITIONS)
    cosine = np.cos(teeth.pair.base_helix_angle)
    face = loaded_face(teeth, LOAD, POSITIONS)
    assert face.dynamic.stiffness == pytest.approx(found.tangent.mean() / cosine**2, rel=1e-9)
    assert face.peak_pressure == found.pressure.max()


def test_the_load_over_the_face_is_that_of_all_slices() -> None:
    found = cycle(PAIRS["helical"], LOAD, POSITIONS)
    z, load = load_per_width(found, WIDTH, 16)
    stretch = WIDTH / 16
    normal = LOAD / np.cos(PAIRS["helical"].pair.base_helix_angle)
    assert load.sum() * stretch == pytest.approx(normal, rel=1e-9)
    # Stretches tell the moment but for where a slice stands inside of one.
    assert load @ z * stretch == pytest.approx(found.moment.mean(), abs=0.02 * normal * WIDTH)


def test_a_spur_pair_seen_from_its_other_end_is_the_opposite_misalignment() -> None:
    teeth = PAIRS["spur"]
    here = loaded_face(teeth, LOAD, POSITIONS)
    there = loaded_face(mirrored(teeth), LOAD, POSITIONS).mirrored
    assert there.moment == pytest.approx(here.moment, rel=1e-9)
    assert there.peak_place == pytest.approx(here.peak_place, rel=1e-9)
    assert there.line_load == pytest.approx(here.line_load, rel=1e-6)
    # The flanks stand apart at larger z, so that the smaller one carries.
    assert here.moment < 0.0
    assert here.peak_place < 0.0
