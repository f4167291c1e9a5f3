"""Small models that hold one key or another of each kind."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import rotorgear as rg
from tests.models import cantilever, disk, disk_in_bearing, spur_pair
from tests.paths import MODELS as SHIPPED

RELIEVED = {
    "tip_relief": "10 um",
    "tip_relief_diameter": "100 mm",
    "flank": {"crowning": "5 um"},
    "ball_diameter": "9 mm",
}
MESH = {
    "backlash": "2 um",
    "stiffness_variation": [{"harmonic": 1, "amplitude": 0.1}],
    "corner_impact": {"force": 40.0, "duration": 0.3, "at": 0.2},
    "friction_coefficient": 0.05,
    "application_factor": 1.2,
}
PUSH = {"shaft": "two", "at": 0.03, "force": [0.0, -300.0, 0.0]}
UNBALANCE = {"u": {"shaft": "two", "at": 0.06, "magnitude": 5e-3}}
BALLS = {"kind": "ball", "elements": 9, "element_diameter": 0.0115, "pitch_diameter": 0.0435, "clearance": 1e-5}
JOURNAL = 'journal = { diameter = "60 mm", length = "30 mm", clearance = "60 um", viscosity = "0.02 Pa s" }'

TEETH = {"meshes__pair__stiffness": "tooth_fe", "meshes__pair__stiffness_variation": []}


def full(**changes: Any) -> rg.Model:
    """A spur pair with nearly all that a mesh can have."""
    return spur_pair(
        **{
            **{f"meshes__pair__{key}": value for key, value in MESH.items()},
            **{f"gears__pinion__{key}": value for key, value in RELIEVED.items()},
            "unbalances": UNBALANCE,
            "loads": {"push": PUSH, "shake": {**PUSH, "order": 1.0}},
            "operation__gravity": [0.0, -9.81, 0.0],
            "shafts__one__internal_damping": 1e-4,
            "scatter": {"bearings.*.stiffness": {"sigma": 0.1}},
            **changes,
        }
    )


def torques(**brake: Any) -> rg.Model:
    """A pair between a drive and a brake."""
    shafts = {"one": {"kind": "input", "torque": 200.0, "ripple": 0.1}, "two": {"kind": "output", **brake}}
    loads = {f"on_{name}": {"shaft": name, **load} for name, load in shafts.items()}
    return spur_pair(operation__torque=None, operation__output_shaft=None, loads=loads)


def rotor(**changes: Any) -> rg.Model:
    """A shaft with a disk that tilts, without gears."""
    model = cantilever({"length": 0.4, "outer_diameter": 0.03})
    return model.with_("disks", {"d": disk(mass=4.0, polar=0.08, tilt=0.04)}).with_(
        {
            "operation": {"input_shaft": "rotor", "speed": 100.0, "gravity": [0.0, -9.81, 0.0]},
            "unbalances": {"u": {"shaft": "rotor", "at": "end", "magnitude": 1e-4}},
            "damping.rayleigh_beta": 1e-5,
            "points": {"tip": {"shaft": "rotor", "at": "end", "direction": "y"}},
            **changes,
        }
    )


def train(**mesh: Any) -> rg.Model:
    """Three gears in a row, in torsion only."""

    def gear(teeth: int, shaft: str) -> dict[str, Any]:
        sizes = {"teeth": teeth, "base_radius": 1e-3 * teeth, "mass": 1.0}
        inertias = {"polar_inertia": 1e-6 * teeth**2, "diametral_inertia": 5e-7 * teeth**2}
        return {"shaft": shaft, "at": "start", "kind": "spur", **sizes, **inertias}

    shared = {"centre_line_angle": 0.3, "pressure_angle": 0.349, "phase": 0.4, "damping_ratio": 0.05, "backlash": 1e-4}
    shared |= {"transmission_error": [{"harmonic": 1, "amplitude": 1e-6}]}
    return rg.Model(
        schema_version=1,
        motions=["torsion"],
        operation={"input_shaft": "a", "output_shaft": "c", "speed": 120.0, "power": 5e3},
        shafts={name: {} for name in "abc"},
        gears={"pinion": gear(23, "a"), "idler": gear(31, "b"), "wheel": gear(57, "c")},
        meshes={
            "one": {"pinion": "pinion", "gear": "idler", "stiffness": 3e8, **shared, **mesh},
            "two": {"pinion": "idler", "gear": "wheel", "stiffness": 4e8, **shared, **mesh},
        },
    )


FILM = {"radius": "20 mm", "length": "20 mm", "clearance": "90 um", "viscosity": "0.01 Pa s"}
ELEMENT = {"law": "journal_bearing", "shaft": "two", "at": "end", "parameters": FILM}

MODELS: dict[str, Callable[[], rg.Model]] = {
    "plain": spur_pair,
    "full": full,
    "torsion": lambda: full(motions=["torsion"], loads={}),
    "no torque": lambda: full(operation__torque=None, loads={}),
    "iso": lambda: full(meshes__pair__stiffness="iso", meshes__pair__stiffness_variation=[]),
    "potential energy": lambda: full(meshes__pair__stiffness="potential_energy", meshes__pair__stiffness_variation=[]),
    "listed": lambda: full(meshes__pair__stiffness=[2.6e8, 3.4e8, 3.2e8, 2.8e8], meshes__pair__stiffness_variation=[]),
    "loaded teeth": lambda: full(**TEETH),
    "loaded teeth that tilt": lambda: full(**TEETH, meshes__pair__tilt=True, meshes__pair__misalignment="20 um"),
    "tilting": lambda: full(meshes__pair__tilt=True, meshes__pair__misalignment="60 um", operation__gravity=None),
    "misaligned": lambda: full(meshes__pair__misalignment="2 um", meshes__pair__index_error="3 um"),
    "two descriptions": lambda: full(bearings__a__rolling=BALLS),
    "balls": lambda: full(
        bearings__c={"shaft": "two", "at": "start", "rolling": BALLS},
        loads={"push": PUSH},
        shafts__one__internal_damping=None,
    ),
    "element": lambda: full(nonlinear_elements={"n": ELEMENT}),
    "element with a stiffness": lambda: full(nonlinear_elements={"n": {**ELEMENT, "stiffness": {"radial": 2e6}}}),
    "ripple": torques,
    "step": lambda: torques(step_at="0.005 s", step_to=0.5),
    "square law": lambda: torques(speed_power=2.0),
    "rotor": rotor,
    "journal": lambda: disk_in_bearing(JOURNAL, '["0 N", "-500 N", "0 N"]', speed="1500 rpm"),
    "idler": train,
    "idler with ripple": lambda: train(
        stiffness_variation=[{"harmonic": 1, "amplitude": 0.15}], application_factor=1.1
    ),
    "split torque": lambda: rg.load(SHIPPED / "split_torque.toml"),
    "backlash pair": lambda: rg.load(SHIPPED / "backlash_pair.toml"),
}
