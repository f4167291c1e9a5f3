"""The rig comparison in a terminal of 80 columns."""

from __future__ import annotations

import io
import subprocess
import sys

from rich.console import Console

from rotorgear.analysis.rig.compare import compare_lines as compare
from rotorgear.results.comparison import ExcitationLine, RigLine


def render(comparison, encoding="utf-8"):
    stream = io.TextIOWrapper(io.BytesIO(), encoding=encoding)
    Console(file=stream, width=80).print(comparison.table())
    stream.seek(0)
    return stream.read()


def example():
    modes = [0.0, 361.2, 361.6, 835.0, 1818.2, 2500.0, 4410.0, 4700.0]
    rig = [RigLine(361, "A1 [left]", 3.0, 0.012), RigLine(1818), RigLine(3000, "cover"), RigLine(4415)]
    excitations = [ExcitationLine("stage_2 mesh 1x", 1818.27), ExcitationLine("input 3x", 834.0)]
    description = ["branch_a torsion against branch_b, 71 %"] * 8
    return compare(modes, description, rig, damping_ratio=[0.01] * 8, excitations=excitations, samples=50)


def test_no_line_is_wider_than_the_terminal_and_no_column_is_cut():
    text = render(example())
    assert max(map(len, text.splitlines())) <= 80
    assert "…" not in text


def test_everything_that_the_comparison_found_is_said():
    text = " ".join(render(example()).split())
    for part in (
        "3: 361.6 Hz",
        "A1 [left]",
        "damping: rig 1.2 %, model 1 %",
        "stage_2 mesh 1x 1818.3 Hz",
        "Rig line 3000.0 Hz (cover) has no mode within 5 %; the nearest is 6: 2500.0 Hz (-16.67 %).",
        "Without a rig line: 3 of 6 elastic modes",
        "mode 4 with input 3x 834.0 Hz",
        "measured in log frequency",
        example().verdict,
    ):
        assert part in text


def test_a_terminal_without_unicode_gets_the_same_table():
    assert "361.2" in render(example(), encoding="ascii")


def test_a_comparison_without_matches_has_no_empty_table():
    text = render(compare([100.0, 500.0], ["", ""], [RigLine(200.0), RigLine(300.0)], samples=20))
    assert "rig Hz" not in text
    assert "None of the 2 rig lines" in text


def test_the_module_imports_without_rich_or_numpy():
    code = "import sys, rotorgear.results.comparison; sys.exit(any(n in sys.modules for n in ('rich', 'numpy')))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
