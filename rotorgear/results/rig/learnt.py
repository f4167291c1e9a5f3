"""What measured lines teach of a model's uncertain numbers."""

from __future__ import annotations

from rotorgear.results.schema import Record, of

# A number that the lines settle to less than half is never called identified.
IDENTIFIED = 0.5
# Below this share the lines say nothing that anybody could use.
UNSEEN = 0.01


class LearntParameter(Record):
    """One uncertain number, before and after the lines; standard deviations relative to its value."""

    address: str = of("address in the model file")
    prior: float = of("relative standard deviation before the test")
    sigma: float = of("relative standard deviation after the test")
    learnt: float = of("share of the prior variance that the lines removed", form=".0%")


def learnt_words(rows: tuple[LearntParameter, ...], lines: int, what: str) -> str:
    """Two sentences: how many numbers the lines teach, and which ones best and not at all.

    Args:
        rows: the parameters.
        lines: number of measured values.
        what: the measured values in the plural, such as "matched lines".
    """
    total = sum(row.learnt for row in rows)
    best = max(rows, key=lambda row: row.learnt)
    head = (
        f"The {lines} {what} teach {total:.1f} of {len(rows)} parameters. Best known: {best.address}, "
        f"±{100 * best.sigma:.2g} % from ±{100 * best.prior:.2g} %"
    )
    unseen = [row.address for row in rows if row.learnt < UNSEEN]
    return f"{head}. They say next to nothing of {', '.join(unseen)}." if unseen else f"{head}."
