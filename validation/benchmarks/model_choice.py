"""Costs of kinds of teeth, bearings and casings in `modal`: python -m validation.benchmarks.model_choice

Seconds are those of the processor, of the first call with an empty cache and of a second one of the same model in the same
process, which has what the first has found. Changes are the largest of the lowest elastic frequencies, as many as the group
says, beside those of its first model. An elastic casing has modes of its own among them, so that only the lowest is compared.
"""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Mapping
from typing import Any

import numpy as np

import rotorgear as rg
from rotorgear.model.model import Model
from tests.paths import ROOT

OIL = {"diameter": "20 mm", "length": "15 mm", "clearance": "20 um", "viscosity": "20 mPa s"}
TEETH = {
    "a number": "9.4e8 N/m",
    "iso": "iso",
    "contact_line": "contact_line",
    "potential_energy": "potential_energy",
    "tooth_fe": "tooth_fe",
}
BEARINGS: dict[str, dict[str, Any]] = {
    "a number": {},
    "ball bearings, 6204": {"rolling": {"designation": "6204"}},
    "plain journals": {"journal": OIL},
    "three lobes": {"journal": OIL | {"lobes": 3, "preload": 0.3}},
    "four tilting pads": {"journal": OIL | {"pads": 4, "preload": 0.3}},
}


COMPARED = {"teeth of helical_pair": 8, "bearings of jeffcott": 2, "ground of split_torque": 1}


def models() -> dict[str, dict[str, Model]]:
    """The models of each group by their names, that to compare with first."""
    pair = rg.load(ROOT / "models" / "helical_pair.toml")
    rotor = rg.load(ROOT / "models" / "jeffcott.toml")
    held = {"operation.gravity": [0.0, -9.81, 0.0], "supports.air.stiffness": {"axial": "1e7 N/m"}}
    files = {"rigid ground": "split_torque", "elastic casing": "split_torque_casing"}
    return {
        "teeth of helical_pair": {name: pair.with_("meshes.stage.stiffness", value) for name, value in TEETH.items()},
        "bearings of jeffcott": {name: rotor.with_(held | _bearings(law)) for name, law in BEARINGS.items()},
        "ground of split_torque": {name: rg.load(ROOT / "models" / f"{file}.toml") for name, file in files.items()},
    }


def _bearings(law: Mapping[str, Any]) -> dict[str, Any]:
    """The changes that put a law into both bearings of the rotor."""
    changes: dict[str, Any] = {}
    for name, at in (("left", "start"), ("right", "end")) if law else ():
        changes[f"bearings.{name}"] = {"shaft": "rotor", "at": at, **law}
    return changes


def solved(model: Model) -> tuple[float, np.ndarray]:
    """Processor seconds of the modes, and the elastic frequencies in Hz from the lowest on."""
    begun = time.process_time()
    result = rg.modal(model, modes=12)
    seconds = time.process_time() - begun
    found = np.sort(np.asarray(result.natural_frequency_hz))
    return seconds, found[found > 1.0]


def main() -> None:
    """Print a line for each model."""
    with tempfile.TemporaryDirectory() as folder:
        os.environ["ROTORGEAR_CACHE"] = folder
        rg.modal(rg.load(ROOT / "models" / "torsion_chain.toml"))  # what loads once
        for group, kinds in models().items():
            count = COMPARED[group]
            print(f"{group:<24}first s  again s   lowest Hz   largest change of the lowest {count}")
            usual = None
            for name, model in kinds.items():
                first, _ = solved(model)
                again, hz = solved(model)
                usual = hz if usual is None else usual
                change = 100.0 * np.max(np.abs(hz[:count] / usual[:count] - 1.0))
                print(f"  {name:<22}{first:7.2f}  {again:7.2f}  {hz[0]:10.2f}  {change:6.2f} %", flush=True)


if __name__ == "__main__":
    main()
