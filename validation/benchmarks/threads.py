"""Two threads against one on the commands of the docs: processor and elapsed time.

Run  python -m validation.benchmarks.threads [--only NAMES] [--repetitions N] [--longest SECONDS]. Threads are those of linear
algebra and numba. On a busy machine only processor time says something. Exit code 1 where two threads take more than a tenth, and
more than 0.05 s, of processor time and of elapsed time longer.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from validation.benchmarks.commands import ROOT, medians, of_the_docs, timed

TOLERANCE = 1.1
LEAST = 0.05  # s, below which a difference is that of the clock


def environment(threads: int) -> dict[str, str]:
    """So many threads everywhere."""
    names = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS", "NUMBA_NUM_THREADS")
    return dict.fromkeys(names, str(threads))


def main() -> int:
    """Print a line for each command; 0 where none is slower with two threads."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repetitions", type=int, default=5)
    parser.add_argument("--longest", type=float, default=30.0, help="processor seconds of a command that is repeated")
    parser.add_argument("--only", default="", help="these commands, with commas between them")
    given = parser.parse_args()
    chosen = given.only.split(",") if given.only else None
    print("   CPU 1    CPU 2  ratio   wall 1   wall 2  ratio  rotorgear ...")
    folder = tempfile.TemporaryDirectory()
    shutil.copytree(ROOT / "models", Path(folder.name) / "models")
    slow = []
    for words in of_the_docs():
        if chosen and words[0] not in chosen:
            continue
        rows: dict[int, list[tuple[float, float]]] = {1: [], 2: []}
        try:
            for _ in range(given.repetitions):
                for threads in rows:
                    rows[threads].append(timed(words, ROOT, environment(threads), Path(folder.name)))
                if rows[1][0][0] > given.longest:
                    break
        except subprocess.CalledProcessError:
            continue  # an example of a refusal
        (cpu_1, wall_1), (cpu_2, wall_2) = medians(rows[1]), medians(rows[2])
        later = [new > TOLERANCE * old and new > old + LEAST for old, new in ((cpu_1, cpu_2), (wall_1, wall_2))]
        if all(later):
            slow.append(words)
        times = f"{cpu_1:8.2f} {cpu_2:8.2f} {cpu_2 / cpu_1:6.2f} {wall_1:8.2f} {wall_2:8.2f} {wall_2 / wall_1:6.2f}"
        print(f"{times}  {' '.join(words)}{'  <-' if all(later) else ''}", flush=True)
    print(f"{len(slow)} commands are slower with two threads")
    return 1 if slow else 0


if __name__ == "__main__":
    sys.exit(main())
