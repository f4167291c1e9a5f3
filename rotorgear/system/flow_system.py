"""A model assembled about its torque flow: where an analysis begins that knows no equilibrium yet."""

from __future__ import annotations

from rotorgear.model.layout.mesh_force import Kind
from rotorgear.model.model import Model
from rotorgear.system.plan import Plan
from rotorgear.system.system import System


def flow_system(
    model: Model, plan: Plan | None = None, *, direction: int | None = None, kind: Kind = "dynamic"
) -> System:
    """The system about the torque flow of one sense of rotation, None for that of the operating speed, on the mesh of a plan.

    `kind` is the stiffness of its contacts where that depends on the load: "static" where an equilibrium is looked for.
    """
    return System(model, plan=plan, state=model.torque_flow(direction).of_kind(kind))
