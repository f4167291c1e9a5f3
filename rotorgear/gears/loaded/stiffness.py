"""Mesh stiffness from finite elements and loaded tooth contact, as a stiffness model among the others."""

from __future__ import annotations

from rotorgear.errors import AnalysisError
from rotorgear.gears.loaded.helix_cycles import helix_cycle
from rotorgear.gears.stiffness.mesh_stiffness import MeshStiffness, ToothPair


def tooth_fe_stiffness(teeth: ToothPair, load: float | None, positions: int) -> MeshStiffness:
    """Secant and tangent stiffness of one helix over one mesh period at F_bt = load (N), at some positions of it."""
    if not load:
        raise AnalysisError(
            "The stiffness of loaded teeth needs a load: give the torque or power that the mesh carries."
        )
    found = helix_cycle(teeth, load, positions)
    return MeshStiffness(
        model="tooth_fe",
        position=found.cycle.position,
        transverse=found.cycle.secant,
        definition="secant",
        helices=1,
        load=load,
        body=found.problem.body,
        base_helix_angle=found.problem.line.base_helix_angle,
        warnings=found.problem.warnings + found.cycle.warnings,
        tangent=found.cycle.tangent,
        event=found.event,
    )
