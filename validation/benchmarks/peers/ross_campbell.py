"""Campbell diagrams against ROSS: one rotor with 200 elements at 50 speeds, the geared pair of C1 with 63 elements at 30.

Both programs get the same speeds and numbers of modes. Frequencies are compared at the last speed.
"""

from __future__ import annotations

import contextlib
import io
import statistics
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np

import rotorgear as rg
from rotorgear.system.system import System
from validation.benchmarks.peers import ross_geared, ross_modal
from validation.benchmarks.peers.comparison import AGREEMENT, ross

SINGLE = 100.0
GEARED = 12.0


def timed(run: Callable[[], Any], repetitions: int) -> tuple[float, Any]:
    """Median processor time in s, and the last result."""
    times = []
    result = None
    for _ in range(repetitions):
        start = time.process_time()
        with contextlib.redirect_stdout(io.StringIO()):
            result = run()
        times.append(time.process_time() - start)
    return statistics.median(times), result


def compare(
    name: str, theirs: Callable[[], Any], ours: Callable[[], rg.CampbellResult], modes: int, aim: float
) -> bool:
    """Run both, print the line of the table; whether the aim is met and the frequencies agree."""
    slow, reference = timed(theirs, 1)
    ours()
    fast, result = timed(ours, 5)
    wanted = np.sort(result.frequency_hz[-1][np.isfinite(result.frequency_hz[-1])])[:modes]
    listed = np.sort(np.asarray(reference.wd)[-1]) / (2.0 * np.pi)
    # every branch of ours within ROSS's list: the two choose their lowest modes by different rules
    worst = max(float(np.min(np.abs(listed / f - 1.0))) for f in wanted)
    ratio = slow / fast
    print(f"{name:34} {slow:8.2f} s {fast:9.3f} s {ratio:8.1f} {aim:6.0f}   {worst:.1e}   {result.basis_error:.0e}")
    return ratio >= aim and worst < AGREEMENT


def main() -> int:
    """Print both comparisons; 0 where aims and agreement are met."""
    print(f"ROSS {ross.__version__}; processor time of one thread\n")
    print(f"{'':34} {'ROSS':>10} {'rotorgear':>11} {'ratio':>8} {'aim':>6}   differ    basis error")
    single = ross_modal.ross_rotor()
    speeds = np.linspace(0.0, 500.0, 50)
    system = System(ross_modal.own_model(), 1)
    good = compare(
        "one rotor, N = 200, 50 speeds",
        lambda: single.run_campbell(speeds, frequencies=6),
        lambda: rg.campbell(system, speeds=speeds.tolist(), modes=6, error_estimate=False),
        6,
        SINGLE,
    )
    pair = ross_geared.ross_rotor()
    own = rg.load(ross_geared.FILE)
    fewer = np.linspace(1.0, 200.0, 30)
    geared = System(own, ross_geared.REFINE)
    good &= compare(
        "geared pair, 63 elements, 30 speeds",
        lambda: pair.run_campbell(fewer, frequencies=10),
        lambda: rg.campbell(geared, speeds=fewer.tolist(), modes=10, error_estimate=False),
        10,
        GEARED,
    )
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
