"""What a line of expected.csv can compare: the number that rotorgear gives, and a reader's words for it.

frequency_hz, whirl, ...           of every elastic mode of a modal result
forced_amplitude_m, ...            of every order of a forced response at one speed, at the first named point
sheet gears.pinion.tip_diameter_m  a key of a row of the gear sheet
mesh pair.ste_peak_to_peak_m       a key of a mesh with loaded teeth; "mesh pair.stiffness_n_per_m 0" is the first value of a
                                   list; " per width" after a key divides by the face width of the helices
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

import rotorgear as rg
from rotorgear.errors import AnalysisError
from rotorgear.results.modal import ModalResult
from rotorgear.results.response import ResponseResult

SHEET = "sheet "
TEETH = "mesh "
_PER_WIDTH = " per width"


def _log_decrement(result: ModalResult) -> np.ndarray:
    zeta = result.damping_ratio
    return 2.0 * np.pi * zeta / np.sqrt(1.0 - zeta**2)


MODAL: Mapping[str, Callable[[ModalResult], np.ndarray]] = MappingProxyType(
    {
        "frequency_hz": lambda result: result.frequency_hz,
        "frequency_rad_s": lambda result: 2.0 * np.pi * result.frequency_hz,
        "frequency_cpm": lambda result: 60.0 * result.frequency_hz,
        "natural_frequency_hz": lambda result: result.natural_frequency_hz,
        "natural_frequency_rad_s": lambda result: 2.0 * np.pi * result.natural_frequency_hz,
        "damping_ratio": lambda result: result.damping_ratio,
        "log_decrement": _log_decrement,
        "real_part_1_s": lambda result: result.eigenvalues.real,
        "whirl": lambda result: np.array(result.whirl),
    }
)


def _displacement(result: ResponseResult) -> np.ndarray:
    """Complex displacement of the first point, (o,)."""
    w = 2.0 * np.pi * result.frequency_hz[:, 0]
    return np.asarray(-result.acceleration[:, 0, 0] / w**2)


FORCED: Mapping[str, Callable[[ResponseResult], np.ndarray]] = MappingProxyType(
    {
        "forced_amplitude_m": lambda result: np.abs(_displacement(result)),
        "forced_lag_rad": lambda result: -np.angle(_displacement(result)),
    }
)

_UNITS = {"hz": "Hz", "m": "m", "rad": "rad", "rad_s": "rad/s", "cpm": "cpm", "1_s": "1/s"}


def words(quantity: str) -> str:
    """Return a quantity as a reader writes it: frequency_rad_s is "frequency in rad/s"."""
    if quantity.startswith(TEETH):
        mesh, _, key = quantity.removeprefix(TEETH).partition(".")
        return f"{mesh}: {key.replace('_', ' ')}"
    if quantity.startswith(SHEET):
        _, part, key = quantity.removeprefix(SHEET).split(".")
        return f"{part}: {key.replace('_', ' ')}"
    for end, unit in _UNITS.items():
        if quantity.endswith("_" + end):
            return f"{quantity.removesuffix('_' + end).replace('_', ' ')} in {unit}"
    return quantity.replace("_", " ")


def elastic(result: ModalResult, quantity: str) -> np.ndarray:
    """Values of a quantity for the modes that are not rigid, lowest natural frequency first."""
    return MODAL[quantity](result)[~result.rigid]


def sheet_number(file: Path, quantity: str) -> float:
    """A number of the gear sheet.

    Raises:
        AnalysisError: the sheet has no such row or number.
    """
    table, name, key = quantity.removeprefix(SHEET).split(".")
    rows = [row for row in rg.gear(rg.load(file)).to_dict()[table] if row["name"] == name]
    if not rows or rows[0].get(key) is None:
        raise AnalysisError(f"{file.name}: the gear sheet has no {quantity.removeprefix(SHEET)}")
    return float(rows[0][key])


@lru_cache(maxsize=32)
def _teeth(file: Path, mesh: str) -> dict[str, Any]:
    return rg.mesh(rg.load(file), mesh, estimate=False).to_dict()


def teeth_number(file: Path, quantity: str) -> tuple[float, int]:
    """A number of a mesh with loaded teeth, and the degrees of freedom of its teeth.

    Raises:
        AnalysisError: the result has no such number.
    """
    mesh, _, rest = quantity.removeprefix(TEETH).removesuffix(_PER_WIDTH).partition(".")
    key, _, place = rest.partition(" ")
    data = _teeth(file, mesh)
    if data.get(key) is None:
        raise AnalysisError(f"{file.name}: the mesh has no {key}")
    value = data[key][int(place)] if place else data[key]
    width = data["face_width_m"] * data["helices"] if quantity.endswith(_PER_WIDTH) else 1.0
    return float(value) / width, int(data["dofs"])
