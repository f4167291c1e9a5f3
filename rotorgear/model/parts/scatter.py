"""How far a number of the file scatters from one machine to the next."""

from __future__ import annotations

from typing import Literal

from pydantic import Field, model_validator

from rotorgear.model.parts.fields import Part, Whole, refuse

Distribution = Literal["normal", "lognormal", "uniform"]


class Scatter(Part):
    """Scatter of the numbers that an address names; one of sigma, tolerance and grade."""

    sigma: float | str | None = Field(
        None, description="standard deviation: a share of the value such as '10 %', or a size such as '0.1 mm'"
    )
    tolerance: float | str | None = Field(
        None,
        description="half width of the tolerance, as sigma: the limits of a uniform distribution, three standard deviations of "
        "the others",
    )
    grade: Whole | None = Field(
        None,
        description="flank tolerance class of ISO 1328-1, of an index_error of a mesh; default: accuracy_grade of its gears",
    )
    distribution: Distribution = Field("normal", description="normal, lognormal (of the value itself) or uniform")

    @model_validator(mode="after")
    def _one_size(self) -> Scatter:
        if sum(size is not None for size in (self.sigma, self.tolerance, self.grade)) != 1:
            raise refuse("one of sigma, tolerance and grade, such as { sigma = '10 %' }")
        return self
