"""The stiffness models by name. A model is a function of a `ToothPair`, the load of one helix and the number of positions.

The model file takes its names from here, so that nothing of numerics is loaded until a stiffness is asked for.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from importlib import import_module
from typing import TYPE_CHECKING

from rotorgear.errors import AnalysisError
from rotorgear.quantity import nearest

if TYPE_CHECKING:
    from collections.abc import Callable

    from rotorgear.gears.stiffness.mesh_stiffness import MeshStiffness, ToothPair

    StiffnessModel = Callable[[ToothPair, float | None, int], MeshStiffness]


@dataclass(frozen=True)
class Registered:
    """A stiffness model by name: where its function is, whether it needs a load, and what it is in a line."""

    home: str
    needs_load: bool
    meaning: str


MODELS = {
    "iso": Registered(
        "rotorgear.gears.stiffness.iso:iso_stiffness",
        False,
        "mean stiffness c_gamma_alpha of ISO 6336-1, without ripple",
    ),
    "contact_line": Registered(
        "rotorgear.gears.stiffness.contact_lines:contact_line_stiffness",
        False,
        "that mean, spread in proportion to the length of the contact lines",
    ),
    "potential_energy": Registered(
        "rotorgear.gears.stiffness.energy:potential_energy_stiffness",
        False,
        "tooth slices as beams on an elastic ring, with Hertz' contact",
    ),
    "tooth_fe": Registered(
        "rotorgear.gears.loaded.stiffness:tooth_fe_stiffness", True, "finite elements and loaded tooth contact"
    ),
}


@lru_cache(maxsize=128)  # a refined analysis asks for the same meshes again and again
def mesh_stiffness(name: str, teeth: ToothPair, load: float | None = None, positions: int = 64) -> MeshStiffness:
    """Stiffness of one helix by a model's name.

    Args:
        name: a key of `MODELS`.
        teeth: the pair.
        load: force F_bt (N) at the base circle of this helix; None where there is none.
        positions: how many positions of one mesh period.

    Raises:
        AnalysisError: no such model, a load that the model needs and doesn't get, or teeth that it can't do.
    """
    if name not in MODELS:
        guess = nearest(name, list(MODELS))
        hint = f"did you mean '{guess}'?" if guess else "there are " + ", ".join(MODELS)
        raise AnalysisError(f"There is no stiffness model '{name}': {hint}.")
    entry = MODELS[name]
    if entry.needs_load and not load:
        raise AnalysisError(
            f"The stiffness model '{name}' needs a load: give the torque or power that the mesh carries."
        )
    module, function = entry.home.split(":")
    model: StiffnessModel = getattr(import_module(module), function)
    curve = model(teeth, load, positions)
    # The cache hands the same arrays out again: nobody may write into them.
    curve.position.flags.writeable = False
    curve.transverse.flags.writeable = False
    return curve
