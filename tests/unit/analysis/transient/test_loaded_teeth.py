"""A transient of loaded teeth at a crawl is their static contact: harmonics and peak to peak of the approach."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.gears.loaded.mesh_cycle import loaded_cycle

CHANGES: dict[str, dict[str, Any]] = {
    "bare": {},
    "relieved": {"tip_relief": 30e-6, "tip_relief_diameter": 0.1775},
    "crowned": {"flank": {"crowning": 10e-6}},
    "pitch error": {"flank": {"pitch_errors": {"1": 20e-6}}},
}
MESH_HZ = 2.0
RECORDS = 512


def pair(change: dict[str, Any], torque: float) -> rg.Model:
    """The spur pair of docs/mesh.md with a change of its pinion."""
    gear = {"at": "100 mm", "kind": "spur", "normal_module": "5 mm", "width": "54 mm"}
    held = {"stiffness": {"radial": 5e8, "axial": 1e8}}
    return rg.Model(
        operation={"input_shaft": "in", "output_shaft": "out", "torque": torque, "speed": MESH_HZ / 34 * 2.0 * np.pi},
        shafts={
            "in": {"position": [0.0, 0.0], "sections": [{"length": 0.2, "outer_diameter": 0.08}]},
            "out": {"position": [0.285, 0.0], "sections": [{"length": 0.2, "outer_diameter": 0.12}]},
        },
        gears={"a": {**gear, "shaft": "in", "teeth": 34, **change}, "b": {**gear, "shaft": "out", "teeth": 80}},
        meshes={"m": {"pinion": "a", "gear": "b", "stiffness": "tooth_fe", "damping_ratio": 0.05}},
        bearings={
            f"{shaft}_{end}": {"shaft": shaft, "at": end, **held} for shaft in ("in", "out") for end in ("start", "end")
        },
        damping={"modal_ratio": 0.1},
    )


CASES = [(change, torque) for change in CHANGES for torque in (1000.0, 2000.0, 4000.0)]
SHORT = (("bare", 2000.0), ("relieved", 4000.0))


@pytest.mark.parametrize(("change", "torque"), [pytest.param(*SHORT[0], marks=pytest.mark.long), SHORT[1]])
def test_a_response_and_a_transient_at_a_crawl_are_the_static_contact(change: str, torque: float) -> None:
    """Harmonics of the approach of a lone spur pair, against the contact solved at even positions without any map."""
    model = pair(CHANGES[change], torque)
    (force,) = model.torque_flow(1).forces
    teeth = model.layout.mesh("m").helix_teeth(0)
    static = loaded_cycle(teeth, force.normal_force, np.arange(RECORDS) / RECORDS)[1].deflection
    expected = 2.0 * np.abs(np.fft.rfft(static))[1:6] / RECORDS
    response = rg.response(model, speeds=[MESH_HZ / 34 * 2.0 * np.pi], elements=1, method="direct")
    assert np.abs(response.approach[:5, 0, 0]) == pytest.approx(expected, rel=0.01, abs=0.005 * expected.max())
    transient = rg.transient(
        model,
        time=1.0 / MESH_HZ,
        discard=4.0 / MESH_HZ,
        records=RECORDS,
        steps=RECORDS,
        elements=1,
        method="exponential",
        error_estimate=False,
    )
    approach = transient.approach[transient.counted, 0][-RECORDS:]
    found = 2.0 * np.abs(np.fft.rfft(approach))[1:6] / RECORDS
    assert found == pytest.approx(expected, rel=0.01, abs=0.005 * expected.max())
    assert np.ptp(transient.approach_range[0]) == pytest.approx(np.ptp(static), rel=0.01)
    at_rest = rg.static(model).mesh_force
    assert response.mean_force == pytest.approx(at_rest, rel=1e-3)
    assert transient.mesh_force[transient.counted].mean(axis=0) == pytest.approx(at_rest, rel=1e-3)


@pytest.mark.long
@pytest.mark.parametrize(("change", "torque"), [case for case in CASES if case not in SHORT])
def test_at_a_crawl_the_approach_is_that_of_the_static_contact(change: str, torque: float) -> None:
    """The force of a single mesh follows from the torque alone: at each position the map is solved for it by itself."""
    model = pair(CHANGES[change], torque)
    load = model.torque_flow(1)
    (force,) = load.forces
    teeth = load.contact_map(force)
    assert teeth is not None
    cycle = teeth.periods / MESH_HZ
    count = RECORDS * teeth.periods
    found = rg.transient(
        model,
        time=2.0 * cycle,
        discard=cycle,
        records=RECORDS,
        steps=RECORDS,
        method="exponential",
        error_estimate=False,
    )
    approach = found.approach[found.counted, 0][-count:]
    phase = 34 * found.angle[found.counted][-count:] + (load.phase(force.contact) or 0.0)
    static = teeth.approach_at(np.full(count, force.normal_force), phase / (2.0 * np.pi))
    assert found.mesh_force[found.counted, 0][-count:].mean() == pytest.approx(force.normal_force, rel=1e-3)
    assert np.ptp(approach) == pytest.approx(np.ptp(static), rel=0.01)
    lines, expected = (
        2.0 * np.abs(np.fft.rfft(x))[teeth.periods : 5 * teeth.periods + 1] / count for x in (approach, static)
    )
    assert lines == pytest.approx(expected, rel=0.01, abs=0.005 * expected.max())
    assert not any("ripple" in note for note in found.left_out)
