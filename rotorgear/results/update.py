"""A model updated by the lines and shapes of a rig: what they teach, what they don't, and how far to trust it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rotorgear.model.model import Model
from rotorgear.model.numbers import free_numbers
from rotorgear.results.comparison import IDENTIFIED, LearntParameter, RigLine, learnt_words
from rotorgear.results.result import ModelResult
from rotorgear.results.schema import Record, derived, of
from rotorgear.results.table import Block, Column, grid, table_of

# Rarer than this by chance, the misfit is the model's: no numbers of it fit the lines.
MISFIT = 0.01
# Two estimates that move together beyond this are one piece of knowledge.
TIED = 0.7


def _error_of(head: str, frequency: str) -> Column:
    """A frequency of the model beside the measured one."""

    def error(line: UpdatedLine) -> float:
        return 100.0 * (float(getattr(line, frequency)) / line.rig.frequency_hz - 1.0)

    return Column(head, error, "{:+.2f} %".format)


class UpdatedParameter(LearntParameter):
    """One free number: its factor beside what was known before and is known after."""

    factor: float = of("most probable value over the value in the file")

    @derived("whether the lines settle it to more than a half")
    def identified(self) -> bool:
        """Below a half learnt, an estimate is mostly the prior's."""
        return self.learnt >= IDENTIFIED


class UpdatedLine(Record):
    """One measured line and its mode; the held-out frequency is predicted from the others, to first order about the estimate."""

    rig: RigLine = of("rig line", record=RigLine)
    campaign: str = of(
        "name of the campaign that measured it", note="; empty where there is one only", column="campaign"
    )
    mode_number: int = of("number of the mode", note=", from 1, rigid-body modes counted", column="mode")
    before_hz: float = of("frequency of the model before the update", "Hz", column="before")
    after_hz: float = of("frequency after the update", "Hz", column="after")
    held_out_hz: float = of("frequency predicted from the other lines alone", "Hz", column="held out")
    held_out_sigma: float = of("relative standard deviation of that prediction, noise of the line included")
    damping_before: float | None = of(
        "damping ratio of the mode before the update", note="; `null` where none was compared", form=".3g"
    )
    damping_after: float | None = of(
        "damping ratio after the update", note="; `null` where none was compared", form=".3g"
    )
    mac_before: float | None = of(
        "MAC of the shape before the update", note="; `null` without shapes", form=".3f", column="MAC before"
    )
    mac_after: float | None = of("MAC after the update", note="; `null` without shapes", form=".3f", column="after")


class UpdatedResponse(Record):
    """One measured frequency response beside the model's; the held-out one is predicted from all else that was measured."""

    campaign: str = of("name of the campaign that measured it", note="; empty where there is one only")
    response: str = of("place of the response")
    reference: str = of("place of the force")
    frac_before: float = of("FRAC before the update")
    frac_after: float = of("FRAC after the update")
    frac_held_out: float = of("FRAC of the response predicted from the others")


class UpdateResult(ModelResult, kind="update"):
    """The update of a model; `model` is the one before, `updated_model()` the one after."""

    parameters: tuple[UpdatedParameter, ...] = of("free numbers", "", "parameter", record=UpdatedParameter)
    lines: tuple[UpdatedLine, ...] = of("measured lines with a mode", "", "line", record=UpdatedLine)
    unmatched: tuple[RigLine, ...] = of("measured lines without a mode", "", "unmatched_line", record=RigLine)
    responses: tuple[UpdatedResponse, ...] = of("measured frequency responses", "", "response", record=UpdatedResponse)
    correlation: np.ndarray = of("correlation of the estimates", "", "parameter", "parameter")
    points: tuple[str, ...] = of("names of the points", "", "point", note=" where shapes were measured")
    chi_squared: float = of("weighted sum of squares at the estimate", note=": measured values and priors together")
    measured_values: int = of("number of independent measured values")
    misfit_probability: float = of("chance of so large a sum of squares if the model is right")
    modal_solutions: int = of("modal solutions that were needed")

    @derived("effective number of parameters that the lines teach", note=": the sum of the learnt shares")
    def learnt_parameters(self) -> float:
        """Sum of the learnt shares."""
        return float(sum(row.learnt for row in self.parameters))

    @derived("root mean square error of the frequencies before the update")
    def error_before(self) -> float:
        """Relative."""
        return self._rms([row.before_hz for row in self.lines])

    @derived("root mean square error of frequencies predicted from the other lines alone")
    def error_held_out(self) -> float:
        """Relative."""
        return self._rms([row.held_out_hz for row in self.lines])

    @derived("what the update is worth", "", "sentence", note=", in sentences")
    def findings(self) -> tuple[str, ...]:
        """What was proven on held-out lines, whether the model can fit at all, and what stays unknown."""
        said = []
        before = 100.0 * self.error_before
        held_out = 100.0 * self.error_held_out
        if len(self.lines) > 1:
            better = (
                "predicts lines it has not seen better" if held_out < before else "does NOT predict unseen lines better"
            )
            said.append(
                f"Each line held out and predicted from the others: {held_out:.2g} % rms, against {before:.2g} % before: the "
                f"updated model {better}."
            )
        if len(self.responses) > 1:
            mean_before = float(np.mean([row.frac_before for row in self.responses]))
            mean_held_out = float(np.mean([row.frac_held_out for row in self.responses]))
            verdict = "better" if mean_held_out > mean_before else "no better"
            said.append(
                f"Each frequency response held out and predicted from the others: FRAC {mean_held_out:.3f} in the mean, against "
                f"{mean_before:.3f} before: the updated model predicts responses it has not seen {verdict}."
            )
        per = self.chi_squared / max(self.measured_values, 1)
        if self.misfit_probability < MISFIT:
            said.append(
                f"Misfit {per:.1f} times what noise and priors allow (chance {self.misfit_probability:.1g}): the model is wrong "
                "in more than these numbers, or the noise is understated, or a line has the wrong mode"
                + (
                    ", or a sensor looks otherwise than its table says (`compare --shapes` names such)"
                    if self.points
                    else ""
                )
                + ". Don't use the estimates."
            )
        elif self.unmatched:
            count = len(self.unmatched)
            said.append(
                f"Misfit {per:.2f} of what noise and priors allow, without the {count} of {count + len(self.lines)} lines "
                "that have no mode: these are no natural frequencies, or speak against the model."
            )
        else:
            said.append(
                f"Misfit {per:.2f} of what noise and priors allow: nothing speaks against the form of the model."
            )
        names = [row.address for row in self.parameters]
        tied = [
            (float(self.correlation[i, j]), names[i], names[j])
            for i in range(len(names))
            for j in range(i)
            if abs(self.correlation[i, j]) > TIED
        ]
        for value, first, second in sorted(tied, key=lambda row: -abs(row[0]))[:3]:
            known = "their product, not their ratio" if value < 0 else "their ratio, not their product"
            said.append(f"Of {second} and {first} the lines know {known} (correlation {value:+.2f}).")
        return tuple(said)

    def updated_model(self) -> Model:
        """The model with the most probable numbers."""
        numbers = free_numbers(self.model, [row.address for row in self.parameters])
        return numbers.at(np.log([row.factor for row in self.parameters]))

    def _rms(self, found_hz: list[float]) -> float:
        errors = np.log([hz / row.rig.frequency_hz for hz, row in zip(found_hz, self.lines, strict=True)])
        return float(np.sqrt(np.mean(errors**2))) if len(errors) else float("nan")

    def tables(self) -> Iterator[Block]:
        """The numbers, lines and frequency responses before and after, and what the update is worth."""
        yield from self.titled()
        columns = (
            Column("number", "address"),
            Column("prior", "prior", "±{:.3g} %".format, "%"),
            Column("times", "factor", ".4f"),
            Column("after", "sigma", "±{:.2g} %".format, "%"),
            Column("learnt", "learnt", "{:.0f} %".format, "%"),
            Column(" ", lambda row: "" if row.identified else "not identified", left=False),
        )
        yield from (table_of(self, "parameters", *columns), "")
        if self.lines:
            error = [_error_of(when.replace("_", " "), f"{when}_hz") for when in ("before", "after", "held_out")]
            several = ("campaign",) if any(line.campaign for line in self.lines) else ()
            shapes = ("mac_before", "mac_after") if self.points else ()
            rig = Column("rig Hz", "rig.frequency_hz", ".2f")
            percent = "{:.2f} %".format
            damped = any(line.damping_after is not None for line in self.lines)
            damping = (
                Column("damping", lambda line: 100.0 * (line.rig.damping_ratio or float("nan")), percent),
                Column("before", "damping_before", percent, "%"),
                Column("after", "damping_after", percent, "%"),
            )
            yield table_of(self, "lines", *several, rig, "mode_number", *error, *(damping if damped else ()), *shapes)
        if self.responses:
            if self.lines:
                yield ""
            rows = [
                (
                    f"{one.campaign}: " * bool(one.campaign) + f"{one.response} over {one.reference}",
                    *(f"{value:.3f}" for value in (one.frac_before, one.frac_after, one.frac_held_out)),
                )
                for one in self.responses
            ]
            yield grid(rows, "response over force", "FRAC before", "after", "held out", caption="Frequency responses")
        what = "measured values" if self.points or self.responses else "matched lines"
        yield from ("", learnt_words(self.parameters, self.measured_values, what), *self.findings)
        if self.unmatched:
            yield f"Without a mode: {', '.join(f'{line.frequency_hz:.1f}' for line in self.unmatched)} Hz."
        yield from (*self.remarks(), f"{self.modal_solutions} modal solutions of {self.dofs} dofs.")
