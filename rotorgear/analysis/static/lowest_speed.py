"""The lower end of a range of speeds: standstill, but where oil films carry, the lowest speed at which they do."""

from __future__ import annotations

from bisect import bisect_left

from rotorgear.analysis.common.request import speed_in_si
from rotorgear.analysis.static.solve import equilibrate
from rotorgear.errors import AnalysisError
from rotorgear.forces.registry import law_of
from rotorgear.model.model import Model
from rotorgear.note import Note
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.system.system import flow_system

# Of the highest speed: where a lower end is looked for.
_SHARES = (0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)


def needs_rotation(model: Model) -> tuple[str, ...]:
    """Addresses of what carries its shaft only while that turns: films of oil that linear analyses take by their tangents."""
    bearings = [f"bearings.{name}" for name, bearing in model.bearings.items() if bearing.has_film]
    elements = [
        f"nonlinear_elements.{name}"
        for name, element in model.nonlinear_elements.items()
        if not element.is_given and not law_of(element.law).carries_at_rest
    ]
    return (*bearings, *elements)


def lowest_speed(model: Model, given: float | str | None, top: float, least: float = 0.0) -> tuple[float, str]:
    """The speed in rad/s at which a range up to `top` begins, of its sense, and a note where the films have chosen it.

    Where none is given it is `least`; with films that have no equilibrium there, the lowest of some shares of `top` that has one.

    Raises:
        AnalysisError: the end that is given is not below `top` in its sense, or no speed up to `top` has an equilibrium.
    """
    if given is not None:
        low = speed_in_si(given)
        if low * top < 0.0 or abs(low) >= abs(top):
            raise AnalysisError(
                f"the range of speeds is empty: it begins at {low * RPM_PER_RAD_S:.6g} rpm and ends at "
                f"{top * RPM_PER_RAD_S:.6g} rpm (--from, --to)"
            )
        return low, ""
    films = needs_rotation(model)
    if not films:
        return least, ""
    system = flow_system(model, direction=-1 if top < 0.0 else 1, kind="static")
    tried = ([least] if least else []) + [share * top for share in _SHARES if abs(share * top) > abs(least)]

    def carries(speed: float) -> bool:
        try:
            equilibrate(system, speed)
        except AnalysisError:
            return False
        return True

    first = 0 if carries(tried[0]) else bisect_left(tried, True, 1, key=carries)
    if first == len(tried):
        equilibrate(system, top)  # says why
        first -= 1
    what = f"speeds below {abs(tried[first]) * RPM_PER_RAD_S:.6g} rpm of the input shaft"
    names = f"{films[0]} and {len(films) - 1} more" if len(films) > 1 else films[0]
    why = f"the film of {names} carries only while its shaft turns; --from chooses another lower end"
    return tried[first], Note("", what, why)
