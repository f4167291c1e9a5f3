"""Result of a check against rules of standards: each rule named and dated, with value, limit and verdict."""

from __future__ import annotations

import numpy as np

from rotorgear.results.result import ModelResult
from rotorgear.results.schema import Record, of

WITHIN = "within"
NOT_WITHIN = "not within"
NOT_APPLICABLE = "not applicable"


class RuleTable(Record):
    """A rule, and the standard that it follows."""

    name: str = of("name")
    source: str = of("standard, edition and year")
    formula: str = of("what the rule says")


class RuleCheck(Record):
    """A rule applied to a part."""

    rule: str = of("name of the rule")
    part: str = of("part", note=": a shaft, a bearing, a mode or an excitation line")
    quantity: str = of("quantity", note=" that is compared")
    unit: str = of("unit", note=" of value and limit")
    value: float | None = of("value", note="; `null` where there is none")
    limit: float | None = of("limit", note=" of the rule; `null` where it asks for none")
    verdict: str = of("verdict", note=': `"within"`, `"not within"` or `"not applicable"`')
    note: str = of("why, in words", note=", and what is compared")


class ResponseCritical(Record):
    """A peak of the response to unbalance over speed, about which the rules speak."""

    shaft: str = of("shaft", note=" whose unbalance excites")
    description: str = of("what moves")
    whirl: str = of("sense of whirl")
    place_z: float = of("z of the place of the largest response", "m", json="place_z_m")
    unbalance_kg_m: float = of("unbalance on the shaft", "kg m", note=", sum over the antinodes")
    antinodes_z: tuple[float, ...] = of("z of the antinodes that carry it", "m", "antinode", json="antinodes_z_m")
    speed: float = of("speed of the input shaft", "rad/s", json="speed_rpm", note=" at the peak")
    shaft_rpm: float = of("speed of the shaft", "rpm", note=" at the peak")
    below_rpm: float = of("speed N_1 of the shaft", "rpm", note=" at 0.707 of the peak; `null` where it does not fall")
    above_rpm: float = of("speed N_2 of the shaft", "rpm", note=" at 0.707 of the peak; `null` where it does not fall")
    amplification_factor: float = of(
        "amplification factor", note=" N_c/(N_2 - N_1); of one side alone N_c over twice its distance"
    )
    required_percent: float | None = of("margin that the rule asks for", "%", note="; `null`: none, AF below 2.5")
    margin_percent: float = of("separation from the operating speed", "%", note=" of the operating speed")
    error_estimate: float = of("estimated relative discretisation error", note=" of the critical speed", form=".0e")


class StandardsResult(ModelResult, kind="standards"):
    """Rules of standards, applied to a model at its operating speed. A verdict is about one rule, never about a standard."""

    operating_rpm: float = of("operating speed of the input shaft", "rpm")
    balance_grade: float = of("balance quality grade G", "mm/s", json="balance_grade_mm_per_s")
    rules: tuple[RuleTable, ...] = of("rules", "", "rule", record=RuleTable)
    criticals: tuple[ResponseCritical, ...] = of("peaks of the unbalance response", "", "peak", record=ResponseCritical)
    checks: tuple[RuleCheck, ...] = of("rules applied", "", "check", record=RuleCheck)
    curve_speeds: np.ndarray = of(
        "speed of the input shaft", "rad/s", "speed", json="curve_speed_rpm", note=" of the curves"
    )
    curves: dict[str, np.ndarray] = of(
        "major axis of the orbit",
        "m",
        "SHAFT",
        "speed",
        json="unbalance_response_m",
        note=", peak to peak, at the place of the largest response of each shaft, with the unbalance of its first peak",
    )

    def count(self, verdict: str) -> int:
        """How many rules have a verdict."""
        return sum(check.verdict == verdict for check in self.checks)
