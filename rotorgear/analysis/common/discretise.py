"""How shafts are cut for analyses in time: alike in a transient and a sweep, so that both solve the same system."""

from __future__ import annotations

from rotorgear.analysis.common.request import check_whole
from rotorgear.system.plan import Plan


def plan_in_time(elements: int | None = None) -> Plan:
    """Return one element of second order for each shaft segment, or as many basic ones as were asked for.

    Basic elements are exact in statics only. In flexible_pair.toml one of them a piece puts a mode of the shafts 0.5 % off, and
    the largest contact force near its resonance 0.9 %.

    Raises:
        AnalysisError: fewer than one element.
    """
    if elements is not None:
        check_whole("the number of elements", elements)
    return Plan(elements) if elements else Plan(elements=1, order=2)
