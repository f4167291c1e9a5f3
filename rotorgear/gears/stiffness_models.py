"""The stiffness models by name. A model is a function of a `ToothPair`, the load of one helix and the number of positions.

The model file takes its names from here, so that nothing of numerics is loaded until a stiffness is asked for.
"""

from __future__ import annotations

from functools import lru_cache
from importlib import import_module
from typing import TYPE_CHECKING

from rotorgear.errors import AnalysisError
from rotorgear.quantity import did_you_mean

if TYPE_CHECKING:
    from collections.abc import Callable

    from rotorgear.gears.stiffness.mesh_stiffness import MeshStiffness, ToothPair

    StiffnessModel = Callable[[ToothPair, float | None, int], MeshStiffness]


# Where the function of each model is.
MODELS = {
    # Mean stiffness c_gamma_alpha of ISO 6336-1, without ripple.
    "iso": "rotorgear.gears.stiffness.iso:iso_stiffness",
    # That mean, spread in proportion to the length of the contact lines.
    "contact_line": "rotorgear.gears.stiffness.contact_lines:contact_line_stiffness",
    # Tooth slices as beams on an elastic ring, with Hertz' contact.
    "potential_energy": "rotorgear.gears.stiffness.energy:potential_energy_stiffness",
    # Finite elements and loaded tooth contact.
    "tooth_fe": "rotorgear.gears.loaded.helix_cycles:tooth_fe_stiffness",
}
NEEDS_LOAD = ("tooth_fe",)


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
        hint = did_you_mean(name, MODELS, "there are " + ", ".join(MODELS))
        raise AnalysisError(f"There is no stiffness model '{name}': {hint}.")
    if name in NEEDS_LOAD and not load:
        raise AnalysisError(
            f"The stiffness model '{name}' needs a load: give the torque or power that the mesh carries."
        )
    module, function = MODELS[name].split(":")
    model: StiffnessModel = getattr(import_module(module), function)
    curve = model(teeth, load, positions)
    # The cache hands the same arrays out again: nobody may write into them.
    curve.position.flags.writeable = False
    curve.transverse.flags.writeable = False
    return curve
