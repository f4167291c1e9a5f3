"""Speed of compiled kernels of this checkout and another one, paired in one run: CPU time on one thread.

    python -m validation.benchmarks.kernel_pairs /path/to/other [rounds]

Both run in processes of their own, which take turns round by round, so that what else the machine does meets both. Printed: the
median over the rounds of the ratio of CPU times, other over this one (above 1: this one is faster), with least and largest, and
whether the results are the same to the last bit.
"""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

CASES = (
    "lanes n7 m1",
    "lanes n7 m4",
    "lanes n24 m8",
    "lanes n7 m4, 2 tangents",
    "trajectory n7 m4",
    "newmark n7 m4",
    "exponential n7 m4",
)


def system(n: int, m: int):  # type: ignore[no-untyped-def]
    """A chain of n masses with m contacts of different kinds, and its parts for the lanes."""
    from fractions import Fraction

    from rotorgear.forces.mesh_contact import DAMPINGS, MeshContact
    from validation.oscillators import local_system

    random = np.random.default_rng(7)
    words = list(DAMPINGS)
    K = 0.3 * np.eye(n) + 0.1 * (np.eye(n, k=1) + np.eye(n, k=-1))
    laws = []
    for j in range(m):
        law = MeshContact(
            1.0, 0.05, 0.5, contact_damping=words[j % 3], ramp=0.05, order=1.0, error_cos=(0.3,), stiffness_cos=(0.2,)
        )
        laws.append((law, random.uniform(-1.0, 1.0, (n, 1))))
    load = 0.2 * random.uniform(-1.0, 1.0, n)
    local = local_system(np.eye(n), 0.05 * np.eye(n), K, load, laws, speed=0.9)
    return local, [Fraction(1)], tuple(f"c{j}" for j in range(m))


def run(case: str, repeats: int) -> tuple[float, str]:
    """Least CPU time of some runs of a case, and a digest of what it computed."""
    from rotorgear.analysis.sweep.point import ready, still, table_of
    from rotorgear.solvers.lanes.lanes import Plan, Start, run_block
    from rotorgear.solvers.lanes.trajectory import recorded
    from validation.oscillators import integrate

    sizes = case.split(",")[0].split()
    n, m = int(sizes[1][1:]), int(sizes[2][1:])
    local, orders, names = system(n, m)
    point = ready(still(local, orders, names), 0.9)
    start = Start(point.system.rest, np.zeros(n))
    table = table_of(point, 200)

    def once() -> np.ndarray:
        if sizes[0] == "lanes":
            plan = Plan(200, 20, 150, 2 if "tangents" in case else 0)
            return run_block([point.system] * 32, [start] * 32, [table], plan)[5].section
        if sizes[0] == "trajectory":
            return recorded(point.system, start, table, 200, 200)
        method = "average acceleration" if sizes[0] == "newmark" else "exponential"
        return integrate(local, method, 0.02, 20000, point.system.rest, np.zeros(n), 100).q

    found = once()
    least = np.inf
    for _ in range(repeats):
        begun = time.process_time()
        once()
        least = min(least, time.process_time() - begun)
    return least, hashlib.sha256(np.ascontiguousarray(found).tobytes()).hexdigest()[:12]


def serve() -> None:
    """Answer cases read from standard input, one a line."""
    for line in sys.stdin:
        print(json.dumps(run(line.strip(), 3)), flush=True)


def main(other: str, rounds: int = 5) -> None:
    """Run both side by side and print the table."""
    here = Path(__file__).resolve()
    sides = []
    for root in (other, str(here.parents[2])):
        environment = {**os.environ, "PYTHONPATH": root, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
        theirs = Path(root) / here.relative_to(here.parents[2])  # names of modules differ between versions
        command = [sys.executable, str(theirs if theirs.exists() else here), "serve"]
        sides.append(
            subprocess.Popen(
                command, env=environment, cwd=root, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
            )
        )

    def ask(side: subprocess.Popen[str], case: str) -> tuple[float, str]:
        assert side.stdin
        assert side.stdout
        print(case, file=side.stdin, flush=True)
        seconds, digest = json.loads(side.stdout.readline())
        return seconds, digest

    for case in CASES:
        pairs = [[ask(side, case) for side in sides] for _ in range(rounds)]
        ratios = [theirs[0] / ours[0] for theirs, ours in pairs]
        same = "same bits" if len({digest for pair in pairs for _, digest in pair}) == 1 else "other bits"
        print(f"{case:26} {np.median(ratios):.3f} [{min(ratios):.3f}, {max(ratios):.3f}]  {same}", flush=True)
    for side in sides:
        side.terminate()


if __name__ == "__main__":
    if sys.argv[1:2] == ["serve"]:
        serve()
    elif len(sys.argv) < 2:
        print(__doc__)
    else:
        main(sys.argv[1], *map(int, sys.argv[2:3]))
