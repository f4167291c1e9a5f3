"""Acceleration of the split-torque gearbox at its output bearing: lines of the spectrum, and which rig lines are among them."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np

import rotorgear as rg
from rotorgear.model.parts.mesh import ErrorHarmonic
from rotorgear.results.spectrum import RigSpectrum, SpectralLines

_MODELS = Path(__file__).resolve().parents[3] / "models"
_HARMONICS = (5.2e-6, 3.1e-6, 1.8e-6, 0.9e-6, 0.4e-6)
_NAME = "points.output_bearing_y acceleration"


def measure(quantity: str, mode: str) -> float:
    """Frequency of the line of a mesh order to a tenth of a hertz, or the number of rig lines that the spectrum has."""
    lines, beside = run()
    if quantity == "line in Hz":
        return round(float(lines.frequency_hz[[source.startswith(f"mesh {mode}") for source in lines.source]][0]), 1)
    return float(np.isfinite(beside.frequency_hz).sum())


def excited(stiffness: str = "potential_energy") -> rg.Model:
    """The gearbox with the printed transmission error in every mesh, and a stiffness model."""
    model = rg.load(_MODELS / "split_torque.toml")
    harmonics = tuple(ErrorHarmonic(harmonic=n + 1, amplitude=a) for n, a in enumerate(_HARMONICS))
    changed = {"stiffness": stiffness, "transmission_error": harmonics}
    meshes = {name: mesh.model_copy(update=changed) for name, mesh in model.meshes.items()}
    data = model.model_dump(exclude_none=True)
    data["meshes"] = {name: mesh.model_dump(exclude_none=True) for name, mesh in meshes.items()}
    return rg.Model(**data)


@cache
def run(stiffness: str = "potential_energy") -> tuple[SpectralLines, RigSpectrum]:
    """Lines of the spectrum with the printed harmonics of the transmission error, and the rig lines beside them."""
    result = rg.transient(
        excited(stiffness), modal_damping=0.02, steps=80, discard="20 ms", time="60 ms", error_estimate=False
    )
    lines = rg.spectral_lines(result, _NAME)
    return lines, rg.compare_spectrum(result, lines, rg.read_rig_lines(_MODELS / "split_torque_rig.csv"))
