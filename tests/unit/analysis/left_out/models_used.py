"""Small models that hold one key or another of each kind."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

import rotorgear as rg
from tests.free_trains import train
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


def at_random(seed: int) -> rg.Model:
    """A pair or a row of three gears that holds some of all these keys, each with a number of its own."""
    rng = np.random.default_rng(seed)
    while True:
        changes = _drawn(rng)
        try:
            if rng.random() < 0.3:
                meshes = {
                    key.removeprefix("meshes__pair__"): v for key, v in changes.items() if key.startswith("meshes")
                }
                kept = (
                    "backlash",
                    "stiffness_variation",
                    "friction_coefficient",
                    "application_factor",
                    "corner_impact",
                )
                return train(**{key: value for key, value in meshes.items() if key in kept})
            return spur_pair(**changes)
        except rg.ModelError:  # keys that do not go together: draw others
            continue


def _drawn(rng: np.random.Generator) -> dict[str, Any]:
    """Changes of the spur pair, each with even chances."""

    def size(of: float) -> float:
        return float(of * rng.uniform(0.5, 2.0))

    teeth = {
        "backlash": size(1e-5),
        "stiffness_variation": [{"harmonic": int(rng.integers(1, 3)), "amplitude": size(0.1)}],
        "corner_impact": {"force": size(40.0), "duration": 0.3, "at": 0.2},
        "friction_coefficient": size(0.04),
        "application_factor": size(1.0),
        "misalignment": size(2e-6),
        "index_error": size(3e-6),
        "tilt": True,
        "stiffness": ["iso", "potential_energy", [2.6e8, 3.4e8, 3.2e8, 2.8e8]][int(rng.integers(3))],
        "damping_ratio": size(0.03),
        "transmission_error": [],
    }
    load = {"shaft": "two", "at": 0.03, "force": [0.0, -size(300.0), size(50.0)]}
    others = {
        "operation__gravity": [0.0, -9.81, 0.0],
        "operation__torque": None,
        "damping__rayleigh_alpha": size(3.0),
        "damping__rayleigh_beta": size(1e-7),
        "damping__modal_ratio": size(0.01),
        "shafts__one__internal_damping": size(1e-4),
        "shafts__two__internal_damping": size(1e-5),
        "unbalances": {"u": {"shaft": "one", "at": 0.02, "magnitude": size(3e-3)}},
        "loads__push": load,
        "loads__shake": {**load, "order": float(rng.integers(1, 3))},
        "bearings__c": {"shaft": "two", "at": "start", "rolling": BALLS},
        "nonlinear_elements": {"n": {**ELEMENT, "stiffness": {"radial": size(2e6)}}},
        "supports": {"brake": {"shaft": "two", "at": "start", "stiffness": {"torsion": size(1e5)}}},
        "motions": [["torsion"], ["bending", "torsion"]][int(rng.integers(2))],
        "scatter": {"bearings.*.stiffness": {"sigma": 0.1}},
        **{f"gears__wheel__{key}": value for key, value in RELIEVED.items() if key != "ball_diameter"},
    }
    found = {f"meshes__pair__{key}": value for key, value in teeth.items() if rng.random() < 0.4}
    if isinstance(found.get("meshes__pair__stiffness"), str | list):
        found["meshes__pair__stiffness_variation"] = []
    return found | {key: value for key, value in others.items() if rng.random() < 0.25}


RANDOM = 12
MODELS |= {f"random {seed}": partial(at_random, seed) for seed in range(RANDOM)}
