"""Measures what a line of expected.csv asks of loaded teeth: "mesh pair.mean_stiffness_n_per_m" is that key of that mesh.

"mesh pair.stiffness_n_per_m 0" is the first value of a list; " per width" after a key divides by the face width of the helices.
"""

from __future__ import annotations

import time
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import rotorgear as rg
from rotorgear.errors import AnalysisError

if TYPE_CHECKING:
    from pathlib import Path

KIND = "mesh "
_PER_WIDTH = " per width"


def is_of_mesh(quantity: str) -> bool:
    """Whether a quantity belongs to loaded teeth."""
    return quantity.startswith(KIND)


@lru_cache(maxsize=32)
def _solved(file: Path, mesh: str) -> tuple[dict[str, Any], float]:
    start = time.perf_counter()
    found = rg.mesh(rg.load(file), mesh, estimate=False)
    return found.to_dict(), time.perf_counter() - start


def measure_mesh(folder: Path, model: str, quantity: str) -> tuple[float, int, float]:
    """Return a number of a mesh, the degrees of freedom of its teeth and the seconds it took.

    Raises:
        AnalysisError: the result has no such number.
    """
    mesh, _, rest = quantity.removeprefix(KIND).removesuffix(_PER_WIDTH).partition(".")
    key, _, place = rest.partition(" ")
    data, seconds = _solved(folder / model, mesh)
    if data.get(key) is None:
        raise AnalysisError(f"{model}: the mesh has no {key}")
    value = data[key][int(place)] if place else data[key]
    width = data["face_width_m"] * data["helices"] if quantity.endswith(_PER_WIDTH) else 1.0
    return float(value) / width, int(data["dofs"]), seconds


def mesh_words(quantity: str) -> str:
    """Return a quantity of a mesh as a reader writes it: "pair: mean stiffness n per m per width"."""
    mesh, _, rest = quantity.removeprefix(KIND).partition(".")
    return f"{mesh}: {rest.replace('_', ' ')}"
