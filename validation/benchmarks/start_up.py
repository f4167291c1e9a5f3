"""What a small command costs beside another checkout of rotorgear: processor time, in alternation.

Run  git worktree add ../before 675491c; python -m validation.benchmarks.start_up ../before. The aims are 0.56 of that commit for
`modal models/jeffcott.toml` and 0.73 for `--help`.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from validation.benchmarks.commands import ROOT, medians, timed

COMMANDS = (["--help"], ["modal", "--help"], ["modal", "models/jeffcott.toml"], ["check", "models/split_torque.toml"])


def main() -> int:
    """Print a line for each command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("other", type=Path, help="a checkout of the commit to compare with")
    parser.add_argument("--repetitions", type=int, default=11)
    given = parser.parse_args()
    other = given.other.resolve()
    print("before     now  ratio  rotorgear ...   (CPU seconds)")
    for words in COMMANDS:
        first, second = [], []
        for repetition in range(given.repetitions + 1):
            before, now = timed(words, other), timed(words, ROOT)
            if repetition:  # the first one compiles to byte code
                first.append(before)
                second.append(now)
        (old, _), (new, _) = medians(first), medians(second)
        print(f"{old:6.3f}  {new:6.3f}  {new / old:5.2f}  {' '.join(words)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
