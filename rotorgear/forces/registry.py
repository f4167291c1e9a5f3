"""All force laws by name. A new law is one file with a `ForceLaw`, named here."""

from __future__ import annotations

from importlib import import_module

from rotorgear.errors import AnalysisError
from rotorgear.forces.law import ForceLaw

# name -> (module, class)
_HOMES = {
    "mesh_contact": ("mesh_contact", "MeshContact"),
    "mesh_friction": ("mesh_friction", "MeshFriction"),
    "ball_bearing": ("ball_bearing", "BallBearing"),
    "roller_bearing": ("roller_bearing", "RollerBearing"),
    "rotating_force": ("rotating_force", "RotatingForce"),
    "torque_curve": ("torque_curve", "TorqueCurve"),
    "plain_spring": ("plain_spring", "PlainSpring"),
}
_ADDED: dict[str, type[ForceLaw]] = {}


def names() -> tuple[str, ...]:
    """Return the names of all laws."""
    return (*_HOMES, *_ADDED)


def law(name: str) -> type[ForceLaw]:
    """Return a law by its name.

    Raises:
        AnalysisError: there is none of that name.
    """
    if name in _ADDED:
        return _ADDED[name]
    if name not in _HOMES:
        raise AnalysisError(f"there is no force law '{name}'; there are {', '.join(names())}")
    module, cls = _HOMES[name]
    found: type[ForceLaw] = getattr(import_module(f"rotorgear.forces.{module}"), cls)
    return found


def register(name: str, cls: type[ForceLaw]) -> None:
    """Add a law of one's own."""
    _ADDED[name] = cls
