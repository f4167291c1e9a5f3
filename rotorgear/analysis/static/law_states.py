"""Where the laws of bearings and nonlinear elements stand in an equilibrium."""

from __future__ import annotations

from collections.abc import Iterable

from rotorgear.analysis.static.solve import LawState
from rotorgear.results.static import LawRow


def law_rows(states: Iterable[LawState]) -> tuple[LawRow, ...]:
    """Force, deflection and tangent of each law."""
    return tuple(
        LawRow(
            part=state.part.part,
            force=state.force,
            displacement=state.d,
            stiffness=state.stiffness,
            damping=state.damping,
            averaged=bool(state.part.law.cycle()) and state.averaged,
        )
        for state in states
    )
