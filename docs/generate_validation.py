"""The whole rows of docs/validation.md, for the site: each line of each case, each row of the five systems, each extreme case.

The page itself is written by hand, with blocks that its commands print.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import mpmath as mp

from tests.extreme import outcomes
from tests.extreme.references import DIGITS
from validation.case import Case, read_cases
from validation.runner import Row, run
from validation.seeds import rows as seeds
from validation.table import error, number, verdict

# The cases and the extremes take minutes.
LONG = True
PAGE = Path(__file__).with_name("validation.md")

OF_CASES = """## Every line of the cases

*Error* is relative, absolute where the tolerance says "abs". Pairs such as 1+2 are the two planes of a rotationally symmetric
rotor and must agree to 1e-10. "40 el." stands for that number of basic elements in each shaft segment (`--elements 40`),
"accuracy 1e-07" for a mesh refined as `--accuracy 1e-7` asks, "20 > 40 el." for an order measured on two meshes. Lines of one
model share its solution, and its time on one thread of the machine that made this page.
"""

OF_SEEDS = """## Every row of the five systems

Rows at "follows" are not printed in the account but follow from its data; rows at "equations" name misprints, by how much
each breaks a law ([misprints](../validation/seeds/misprints.py)); rows at "claim" are statements without a number. The column
*by* is the test of the row's rule that gave the verdict, with the values that it compares. A row on a motion tells where it
starts, how long it settles and counts, and how many of its starts end in it: the static equilibrium and random states about
it (`--initial-conditions 8`, say). Numbers of chaotic motions are means over the starts that end in chaos, with Student's
interval of 99.7 % (4.5 standard errors for 8 starts); another processor gives others within it. Of extremes in chaos the
lowest and highest of the starts stand: they come in bursts, and grow with the length of the run. Chaos from one start beside
a motion that repeats from another may be a transient, whatever its exponents: it reads "chaotic so far". `python -m
validation.seeds.settling` runs every labelled motion again after ten times the settling and tells which labels change.
"""

SYSTEMS = {
    "marine": (
        "Marine dual-turbine train",
        """Model [marine_dual_turbine.toml](../models/marine_dual_turbine.toml): two
turbines, two stages, in torsion with backlash. The printed equations have no equilibrium; the model is the chain that they
must have meant, with quill shafts between the stages. Stiffness, drag of the LP turbine, mesh frequency, errors and phases
are fitted to the three printed regions: that shows that they can be reached, and predicts nothing. Runs start from rest on
the flanks that carry; where the net torque of the LP turbine is negative (load ratio 0.3) those are the coast flanks. 2000
periods of 8 first-stage mesh periods settle, 200 count, 40 steps a mesh period; 400 leave chaos that dies out later. The
amplitude indicator is the peak to peak deflection of the LP first stage over 16.67 um, the static deflection at 15 kN m; the
impact time ratio is the share of the time on the back side. With the model's file alone, at the load ratios 0.3, 0.6 and 1.0:

```console
$ rotorgear sweep models/marine_dual_turbine.toml --over "loads.lp.torque=6923.077 N m,11250 N m,15000 N m" \\
    --discard 2000 --sample 200 --steps 40 --json regions.json
```

There `points[].runs[]` has `lyapunov` (over a period of the first stage), and its `contacts[]` named `first_lp` has
`back_share` and `peak_to_peak_m`. Over all load ratios above the drag:

```console
$ rotorgear sweep models/marine_dual_turbine.toml --over "loads.lp.torque=11.3 kN m:16.3 kN m:51" \\
    --discard 400 --sample 200 --steps 40 --plot pictures
```

![LP first stage over the LP torque: chaos with back-side contact, then order again](pictures/seeds_marine.png)

Over the load ratio at both total torques, and the three regions with the fitted and with the printed stiffness
(`python -m validation.seeds.pictures_marine seeds_marine_ratio seeds_marine_regions`):

![Poincare points, exponent and shares of time over the load ratio at 30 and 35 kN m](pictures/seeds_marine_ratio.png)

![Exponent, amplitude and back-side share over the load ratio with both stiffnesses](pictures/seeds_marine_regions.png)

The regions over torque and load ratio (`python -m validation.seeds.pictures_marine seeds_marine_map`):

![Regions I, II and III over total torque and load ratio](pictures/seeds_marine_map.png)""",
    ),
    "pair24": (
        "Herringbone pair of 24 degrees of freedom",
        """Models
[herringbone_pair_24dof.toml](../models/herringbone_pair_24dof.toml) (set 1) and
[herringbone_pair_24dof_set2.toml](../models/herringbone_pair_24dof_set2.toml) (set 2). No stiffness, damping, inertia or
clearance is given, so both sets are chosen ones; two rows have set 1 under its weight on rolling bearings with clearance. Each
speed starts from its own static equilibrium, and for the share of starts in set 1 from three random states; 2500 (set 1) or 200
(set 2) mesh periods settle and 640 or 64 count, 160 steps each, and more where the motion has not settled
([sweeps](sweep.md#response-types)); for the rows of table 3 on trends 3000 and 8000, four
starts: the motion of most, and the mean of their shares, good to about 10 %. Shorter runs of set 1 take transients for chaos:
after 250 and 64 periods the exponent at 5950 rpm, say, is not yet that of the motion that stays.
Between 11000 and 13500 rpm set 2 has a motion of one period that a symmetric start stays on for thousands of periods, though
it is unstable: its largest multiplier, by Newton's method and the map over a period, is e^0.0217 at 11000 rpm and e^0.0021 at
13000 rpm, in deviations in which the helices differ.
"kT" says that points k mesh periods apart agree to 2 % of the
peak to peak deflection, "chaotic" that the largest Lyapunov exponent is above 0.02 per mesh period, as in `rotorgear sweep`.

```console
$ rotorgear sweep models/herringbone_pair_24dof.toml --over "operation.speed=4600 rpm:6000 rpm:57" \\
    --discard 2500 --sample 64 --steps 160 --plot pictures
```

![Set 1 over the speed: one period, two, chaos](pictures/seeds_pair24.png)

Set 1 at 6000 rpm over torque, damping, backlash and stiffness, and set 2 over the speed
(`python -m validation.seeds.pictures_pair24 seeds_pair24_studies seeds_pair24_set2`):

![Poincare points of set 1 over torque, damping, backlash and stiffness](pictures/seeds_pair24_studies.png)

![Poincare points and exponent of set 2 over the speed](pictures/seeds_pair24_set2.png)""",
    ),
    "split": (
        "Split-torque gearbox",
        """Model [split_torque.toml](../models/split_torque.toml). Shaft sizes, bearings and
masses are not given; the file is one complete layout whose 25 free numbers were fitted to the 24 printed frequencies, so that
finding them again says nothing; and with its 63 modes even a random list finds partners for most of its lines.
The spectrum at the output bearing, with the printed harmonics of the transmission error at all meshes
(`python -m validation.seeds.pictures_split seeds_split_spectrum`):

![Acceleration at the output bearing, and both mesh frequencies with harmonics](pictures/seeds_split_spectrum.png)""",
    ),
    "pair12": (
        "Herringbone pair of 12 degrees of freedom",
        """Model
[herringbone_pair_12dof.toml](../models/herringbone_pair_12dof.toml), at the printed contact ratio 3.30. Rows at other ratios
take mean and ripple of the stiffness from the contact lines at the printed ratio, and the printed impact. Supports,
stiffness and the impact's length are not given, so the spread over 40 random sets stands beside the chosen one.
Accelerations are those of a pinion half, circumferential at its reference circle; 120 mesh periods settle, 60 count.
The impact stands in the printed equations in the rows of rotation only; a blow along the flank normal pushes along y and z
too. Both are here: the first gives the printed ratio of axial to circumferential vibration in size, the second is what the
model file has.
`python -m validation.seeds.pictures_pair12 seeds_pair12_impact` draws the printed impacts and the vibration that they give:

![Printed impact and computed vibration over the contact ratio](pictures/seeds_pair12_impact.png)""",
    ),
    "pair16": (
        "Herringbone pair of 16 degrees of freedom",
        """Models
[herringbone_pair_16dof.toml](../models/herringbone_pair_16dof.toml) (pair A) and
[herringbone_pair_16dof_b.toml](../models/herringbone_pair_16dof_b.toml) (pair B). The dynamic factor is the largest force of
a helix over its mean (stiffness, damping and impact together) in 60 mesh periods after 250, 200 steps each. It hangs on
every assumption of the set, so the rows after it show what other sets give.
`python -m validation.seeds.pictures_pair16 seeds_pair16_factors` draws the spread:

![Dynamic factors of both pairs over 40 random sets](pictures/seeds_pair16_factors.png)""",
    ),
}

OF_EXTREMES = """## Every stiff and extreme case

* *40 digits*: textbook element matrices, assembled and solved by mpmath with 40 digits.
* *closed form*: a formula, evaluated with 40 digits.
* *similarity*: the same model in other units; all frequencies scale exactly.
* *estimate*: the error over the one that the result states.

The error of modes is the largest relative one of any: of omega without damping, else the distance of s from the exact one over
|s|. It includes modes that are missing or made up; so it does for critical speeds and branches over speed. Of statics and
responses it is that of each deflection and force that is compared. A case names its analysis; without a name it is `modal`. The
column *error* is rounded up to a power of ten; below 1e-10 it says *rounding*.
"""


def pages() -> dict[str, str]:
    """Nothing: the page of the repository is written by hand."""
    return {}


def site_pages() -> dict[str, str]:
    """The page with all rows below it."""
    return {"docs/validation.md": "\n".join([PAGE.read_text(encoding="utf-8"), *_cases(), *_seeds(), *_extremes()])}


def _cases() -> Iterator[str]:
    yield OF_CASES
    for case in read_cases():
        yield f"### {case.title}\n\n{case.text}\n\n{_table(_lines(case))}"


def _lines(case: Case) -> Iterator[Sequence[str]]:
    yield ("what", "expected", "got", "error", "allowed", "", "dofs", "time", "source")
    for row in run([case]):
        got = (row.what, row.expected, number(row.got, row.expected), error(row), row.tolerance or "-", verdict(row))
        yield (*got, str(row.dofs), f"{row.seconds:.2f} s", _source(row))


def _source(row: Row) -> str:
    """Where a line comes from, and why it failed."""
    source = f"{row.source}; {row.note}" if row.note else row.source
    return source + (f"; **{row.reason}**" if row.reason and row.judged else "")


def _seeds() -> Iterator[str]:
    yield OF_SEEDS
    for name, (title, text) in SYSTEMS.items():
        lines = [
            (
                row.where,
                row.what,
                row.printed or "-",
                row.shown.replace("+-", "±"),
                row.unit or "-",
                row.rule,
                row.verdict,
                row.by or "-",
                row.reason or "-",
                row.runs or "-",
            )
            for row in seeds.rows(name)
        ]
        head = ("where", "what", "printed", "computed", "unit", "rule", "verdict", "by", "reason", "motion")
        yield f"### {title}: rows\n\n{text}\n\n{_table([head, *lines])}"


def _extremes() -> Iterator[str]:
    yield OF_EXTREMES
    with mp.workdps(DIGITS):
        yield f"### Computed\n\n{_table(outcomes.computed())}"
        yield f"### Warned about\n\n{_table(outcomes.flagged())}"
        yield f"### Refused\n\n{_table(outcomes.refused())}"
        yield f"### Tried with intent\n\n`python -m tests.extreme` tries them again.\n\n{_table(outcomes.tried())}"
        yield (
            "### With the assembled stiffness alone\n\nThe lowest frequencies of the same models from the same solver.\n\n"
            f"{_table(outcomes.conditioning())}"
        )


def _table(rows: Iterator[Sequence[str]] | Sequence[Sequence[str]]) -> str:
    head, *body = [f"| {' | '.join(row)} |" for row in rows]
    return "\n".join([head, "|" + "---|" * head.count(" | ") + "---|", *body]) + "\n"
