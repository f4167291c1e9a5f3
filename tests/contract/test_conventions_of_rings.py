"""C36 of docs/conventions.md: the contact of an internal pair."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.elements.gear_mesh import contact_vector
from rotorgear.elements.spring import rigid_transfer
from rotorgear.model.layout.state import contact_geometry
from tests.turned import turned
from tests.unit.system.test_internal import star


def test_c36_rigid_motions_and_the_turning_train_strain_no_internal_contact() -> None:
    model = turned(rg.Model(**star()))
    for force in model.torque_flow().forces:
        v = contact_vector(contact_geometry(force))
        motions = []
        for place in (force.contact.pinion_place, force.contact.gear_place):
            frame = model.shafts[place.shaft].frame
            motions.append(frame.six.T @ rigid_transfer(frame.at(place.z)))
        assert np.abs(v @ np.vstack(motions)).max() < 1e-12
        ratios = [
            model.layout.train.ratio(place.shaft) for place in (force.contact.pinion_place, force.contact.gear_place)
        ]
        if force.contact.gear == "ring":
            place, ring = force.contact.pinion_place, model.shafts["ring"].frame
            # The force on the ring pushes its teeth outwards, away from the axis of the pinion and its own.
            outwards = ring.axes.T @ (model.shafts[place.shaft].frame.at(place.z) - ring.at(0.0))
            assert -v[6:9] @ outwards > 0.0
        assert v[5] * ratios[0] + v[11] * ratios[1] == pytest.approx(0.0, abs=1e-14)
