"""Result of a check against rules of standards: each rule named and dated, with value, limit and verdict."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rotorgear.results.result import ModelResult
from rotorgear.results.schema import Record, of
from rotorgear.results.table import Block, Column, Line, error_words, table_of

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

    rule: str = of("name of the rule", column="rule")
    part: str = of("part", note=": a shaft, a bearing, a mode or an excitation line", column="part")
    quantity: str = of("quantity", note=" that is compared")
    unit: str = of("unit", note=" of value and limit", column="unit")
    value: float | None = of("value", note="; `null` where there is none", form=".4g", column="value")
    limit: float | None = of("limit", note=" of the rule; `null` where it asks for none", form=".4g", column="limit")
    verdict: str = of("verdict", note=': `"within"`, `"not within"` or `"not applicable"`', column="verdict")
    note: str = of("why, in words", note=", and what is compared")


class ResponseCritical(Record):
    """A peak of the response to unbalance over speed, about which the rules speak."""

    shaft: str = of("shaft", note=" whose unbalance excites", column="peak, shaft")
    description: str = of("what moves")
    whirl: str = of("sense of whirl")
    place_z: float = of("z of the place of the largest response", "m")
    unbalance_kg_m: float = of("unbalance on the shaft", "kg m", note=", sum over the antinodes")
    antinodes_z: tuple[float, ...] = of("z of the antinodes that carry it", "m", "antinode")
    speed: float = of("speed of the input shaft", "rad/s", note=" at the peak")
    shaft_rpm: float = of("speed of the shaft", "rpm", note=" at the peak", form=".1f", column="rpm")
    below_rpm: float = of(
        "speed N_1 of the shaft", "rpm", note=" at 0.707 of the peak; `null`: it does not fall", form=".1f", column="N1"
    )
    above_rpm: float = of(
        "speed N_2 of the shaft", "rpm", note=" at 0.707 of the peak; `null`: it does not fall", form=".1f", column="N2"
    )
    amplification_factor: float = of(
        "amplification factor", note=" N_c/(N_2 - N_1), of one side N_c/(2 |N - N_c|)", form=".4g", column="AF"
    )
    required_percent: float | None = of(
        "margin that the rule asks for", "%", note="; `null`: none, AF below 2.5", form=".2f", column="asked %"
    )
    margin_percent: float = of(
        "separation from the operating speed", "%", note=" of the operating speed", form="+.2f", column="margin %"
    )
    error_estimate: float = of(
        "estimated relative discretisation error", note=" of the critical speed", form=error_words
    )


class StandardsResult(ModelResult, kind="standards"):
    """Rules of standards, applied to a model at its operating speed. A verdict is about one rule, never about a standard."""

    operating_rpm: float = of("operating speed of the input shaft", "rpm")
    balance_grade: float = of("balance quality grade G", "mm/s")
    rules: tuple[RuleTable, ...] = of("rules", "", "rule", record=RuleTable)
    criticals: tuple[ResponseCritical, ...] = of("peaks of the unbalance response", "", "peak", record=ResponseCritical)
    checks: tuple[RuleCheck, ...] = of("rules applied", "", "check", record=RuleCheck)
    curve_speeds: np.ndarray = of(
        "speed of the input shaft", "rad/s", "speed", json="curve_speed_rpm", note=" of the curves"
    )
    curves: dict[str, np.ndarray] = of(
        "major axis of the orbit, peak to peak",
        "m",
        "SHAFT",
        "speed",
        json="unbalance_response_m",
        note=", at the place of the largest response of each shaft, with the unbalance of its first peak",
    )

    def count(self, verdict: str) -> int:
        """How many rules have a verdict."""
        return sum(check.verdict == verdict for check in self.checks)

    def tables(self) -> Iterator[Block]:
        """Peaks of the unbalance response, each rule with value, limit and verdict, and what the rules say."""
        at = f"{self.model.reference_shaft} at {self.operating_rpm:.6g} rpm"
        yield from (Line(f"{self.model.title or 'Model'}: rules of standards, {at}"), "")
        if self.criticals:
            asked = Column("", "required_percent", where=lambda one: one.required_percent is not None, without="none")
            peak = ("shaft", "shaft_rpm", "below_rpm", "above_rpm", "amplification_factor", "margin_percent", asked)
            yield from (table_of(self, "criticals", *peak), "")
        unit = Column("", "unit", left=False)
        verdict = Column("", "verdict", left=False)
        yield from (table_of(self, "checks", "rule", "part", "value", "limit", unit, verdict), "")
        yield from (f"{rule.name} ({rule.source}): {rule.formula}" for rule in self.rules)
        yield f"{self.dofs} dofs, {self.cost}; {self.method}"
        yield from (*self.remarks(), "")
