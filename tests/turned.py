"""A model written again, turned and moved in space as a whole: what its shafts say in their own frames must stay."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import scipy.linalg as la
from scipy.spatial.transform import Rotation

import rotorgear as rg
from rotorgear.export.layout import display_frames

# Axes of turned models: a turn that mixes all three of them, and a place away from the origin.
TURN = Rotation.from_rotvec([0.7, -1.9, 1.1]).as_matrix()
PLACE = np.array([0.31, -0.22, 0.47])


def turned(model: rg.Model, R: np.ndarray = TURN, at: np.ndarray = PLACE, folder: Path | None = None) -> rg.Model:
    """The model with every place x at R x + at.

    Shafts without a position stand where pictures show them. Casings of matrices are written again into a folder; none may come
    from a mesh.
    """
    tables: dict[str, Any] = model.model_dump(mode="python", exclude_none=True)
    frames = display_frames(model)
    for name, shaft in tables["shafts"].items():
        if "carrier" in shaft:
            continue  # planets stand where their carrier does
        frame = frames[name]
        shaft["position"] = (R @ frame.origin + at).tolist()
        shaft["axis"] = (R @ frame.axes[:, 2]).tolist()
        shaft["x_axis"] = (R @ frame.axes[:, 0]).tolist()
    for mesh in tables["meshes"].values():
        mesh.pop("centre_line_angle", None)
        mesh.pop("pressure_angle", None)
    operation = tables.get("operation", {})
    if "gravity" in operation:
        operation["gravity"] = (R @ operation["gravity"]).tolist()
    for load in tables["loads"].values():
        for key in ("force", "moment"):
            if key in load:
                load[key] = (R @ load[key]).tolist()
        if "history" in load:
            load["history"] = _turned_history(load["history"], R)
    for name, casing in tables["casings"].items():
        assert folder is not None
        file = folder / f"{name}_turned.npz"
        np.savez(file, **turned_arrays(dict(np.load(casing["matrices"])), R, at))
        casing["matrices"] = str(file)
    return rg.Model(**tables)


def turned_arrays(arrays: dict[str, np.ndarray], R: np.ndarray, at: np.ndarray) -> dict[str, np.ndarray]:
    """The arrays of a reduced body, turned with it: its seats have six motions each, along the axes of the model."""
    seats = len(arrays["positions"])
    B = la.block_diag(*[R] * (2 * seats), np.eye(len(arrays["mass"]) - 6 * seats))
    found = dict(arrays)
    for name in ("stiffness", "mass", "damping"):
        if name in arrays:
            found[name] = B @ arrays[name] @ B.T
    found["positions"] = arrays["positions"] @ R.T + at
    if "weight" in arrays:
        found["weight"] = B @ arrays["weight"] @ R.T
    return found


def _turned_history(history: dict[str, Any], R: np.ndarray) -> dict[str, Any]:
    """A history of all six components along turned axes."""
    names = [f"{kind}_{x}" for kind in ("force", "moment") for x in "xyz"]
    values = np.zeros((6, len(history["places"])))
    for name, row in zip(history["components"], history["values"], strict=True):
        values[names.index(name)] = row
    values = np.vstack([R @ values[:3], R @ values[3:]])
    return {**history, "components": names, "values": values.tolist()}


def far_off(value: Any, other: Any) -> float:
    """Largest difference of two arrays over the largest entry, of dicts the largest of their entries."""
    if isinstance(value, dict):
        assert value.keys() == other.keys()
        return max((far_off(value[key], other[key]) for key in value), default=0.0)
    a, b = np.asarray(value), np.asarray(other)
    assert a.shape == b.shape
    size = float(np.max(np.abs(a), initial=0.0))
    return float(np.max(np.abs(a - b), initial=0.0)) / size if size else float(np.max(np.abs(b), initial=0.0))


__all__ = ["PLACE", "TURN", "far_off", "turned", "turned_arrays"]
