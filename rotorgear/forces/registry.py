"""All force laws by name: those of the package, which are loaded when first asked for, and those that are registered.

    @rg.register_law("stop")
    @dataclass(frozen=True)
    class Stop(ForceLaw): ...

makes a law of your own known to model files and to `law_of`, as if it were of the package; forces/law.py says what it must
answer.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import TypeVar

from rotorgear.errors import AnalysisError
from rotorgear.forces.law import ForceLaw

# name -> class, in the module of that name: compiled code is loaded with the module, so not before it is needed
_SHIPPED = {
    "mesh_contact": "MeshContact",
    "loaded_teeth": "LoadedTeeth",
    "mesh_friction": "MeshFriction",
    "journal_bearing": "JournalBearing",
    "journal_film": "JournalFilm",
    "tilting_pads": "TiltingPads",
    "thrust_film": "ThrustFilm",
    "ball_bearing": "BallBearing",
    "roller_bearing": "RollerBearing",
    "tapered_bearing": "TaperedBearing",
    "rotating_force": "RotatingForce",
    "torque_curve": "TorqueCurve",
    "plain_spring": "PlainSpring",
    "tabulated_force": "TabulatedForce",
}
_REGISTERED: dict[str, type[ForceLaw]] = {}
Law = TypeVar("Law", bound=type[ForceLaw])


def shipped() -> tuple[str, ...]:
    """Return the names of the laws of the package."""
    return tuple(_SHIPPED)


def names() -> tuple[str, ...]:
    """Return the names of all laws."""
    return (*_SHIPPED, *_REGISTERED)


def law_of(name: str) -> type[ForceLaw]:
    """Return a law by its name.

    Raises:
        AnalysisError: there is none of that name.
    """
    if name in _REGISTERED:
        return _REGISTERED[name]
    if name not in _SHIPPED:
        raise AnalysisError(f"there is no force law '{name}'; there are {', '.join(names())}")
    law: type[ForceLaw] = getattr(import_module(f"rotorgear.forces.{name}"), _SHIPPED[name])
    return law


def register_law(name: str) -> Callable[[Law], Law]:
    """Register the class below, as a decorator; registered again, the later one counts, as in a notebook that is run twice.

    Args:
        name: by which a model file names the law.

    Returns:
        The decorator; it gives the class back as it is.

    Raises:
        AnalysisError: the name is one of the package's, is no word, or the class is no force law.
    """

    def registered(law: Law) -> Law:
        if name in _SHIPPED:
            raise AnalysisError(f"'{name}' is a force law of the package: choose another name for {law.__name__}")
        if not name.isidentifier():
            raise AnalysisError(f"'{name}' is no name for a force law: expected letters, digits and underscores")
        if not (isinstance(law, type) and issubclass(law, ForceLaw)):
            raise AnalysisError(f"{name}: a force law is a class derived from rotorgear.ForceLaw, got {law!r}")
        _REGISTERED[name] = law
        return law

    return registered
