"""Every validation case holds to its tolerances, and the runner reports what doesn't."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from rotorgear.errors import AnalysisError
from rotorgear.old_names import OldNameWarning
from tests.paths import ROOT
from validation.case import _FORMER_NAMES, Case, names, read_case, read_cases
from validation.runner import main, run
from validation.table import printed

# Most of the time of all cases. Unit tests hold the same physics on smaller problems.
# `python -m validation` runs them all.
LONG_CASES = frozenset(
    {
        "newmark_methods",
        "dead_zone_free",
        "backlash_forced",
        "lyapunov_exponents",
        "meissner_equation",
        "contact_energy",
        "tooth_fe_contact",
        "journal_whirl",
        "split_torque_lines",
        "journal_pressure",
        "thruster_bench",
    }
)


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.long if name in LONG_CASES else ()) for name in names()]
)
def test_a_case_is_within_its_tolerances(name: str) -> None:
    failed = [
        f"{row.what}: expected {row.expected}, got {row.got}: {row.reason}"
        for row in run([read_case(name)])
        if row.judged and not row.passed
    ]
    assert not failed, "\n".join(failed)


@pytest.mark.parametrize("name", names())
def test_a_case_says_where_each_number_comes_from(name: str) -> None:
    case = read_case(name)
    assert len(case.text) > 100
    for line in case.expectations:
        assert line.source, line
        assert line.tolerance or line.note, line


def test_the_cases_of_the_first_version_are_all_there() -> None:
    assert set(names()) >= {
        "timoshenko_beam",
        "axial_and_torsional_bars",
        "spinning_shaft",
        "two_disk_rotor",
        "three_disk_rotor",
        "jeffcott_rotor",
        "turbo_alternator",
        "marine_turbines",
        "torsional_pair_and_chain",
        "rigid_helical_pair",
    }


def _spoiled(name: str, **changes: str) -> Case:
    case = read_case(name)
    return replace(case, expectations=(replace(case.expectations[0], **changes), *case.expectations[1:]))


def test_a_number_off_by_twice_its_tolerance_fails_and_says_why() -> None:
    good = float(read_case("jeffcott_rotor").expectations[0].expected)
    rows = list(run([_spoiled("jeffcott_rotor", expected=f"{good * (1.0 + 2e-6):.10f}")]))
    assert [row.passed for row in rows] == [False, *[True] * 12]
    assert rows[0].reason == "off by 2.0e-06, allowed 1.0e-06"
    assert "FAIL jeffcott_rotor" in printed(rows)
    assert "closed form" in printed(rows).splitlines()[-1]


def test_a_pair_that_is_none_fails() -> None:
    rows = list(run([_spoiled("three_disk_rotor", mode="1+2", tolerance="abs 100")]))
    assert not rows[0].passed
    assert "apart" in rows[0].reason


def test_a_wrong_word_and_a_missed_bound_fail() -> None:
    whirl = next(line for line in read_case("spinning_shaft").expectations if line.quantity == "whirl")
    assert not next(iter(run([_spoiled("spinning_shaft", **{**_text(whirl), "expected": "sideways"})]))).passed
    assert not next(iter(run([_spoiled("timoshenko_beam", expected=">= 4.5")]))).passed


def _text(line: object) -> dict[str, str]:
    return {key: value for key, value in vars(line).items() if isinstance(value, str)}


def test_a_line_without_tolerance_is_shown_and_never_fails() -> None:
    rows = list(run([_spoiled("jeffcott_rotor", expected="1.0", tolerance="")]))
    assert not rows[0].judged
    assert "shown" in printed(rows).splitlines()[1]


def test_an_unknown_case_is_answered_with_those_that_exist() -> None:
    with pytest.raises(AnalysisError, match="no validation case 'Z9'; there are axial_and_torsional_bars, "):
        read_cases(["timoshenko_beam", "Z9"])


def test_former_names_of_cases_are_read_with_a_warning_that_says_the_present_one() -> None:
    with pytest.warns(OldNameWarning, match="validation case 'C8' is now 'rigid_helical_pair'"):
        assert [case.name for case in read_cases(["C8", "rigid_helical_pair"])] == ["rigid_helical_pair"]
    assert set(_FORMER_NAMES.values()) <= set(names())


def test_the_runner_prints_a_table_writes_json_and_returns_0(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["rigid_helical_pair"], tmp_path / "rows.json") == 0
    assert "11 of 11 within tolerance" in capsys.readouterr().out
    rows = json.loads((tmp_path / "rows.json").read_text())["rows"]
    assert len(rows) == 11
    assert all(row["passed"] and row["dofs"] == 12 and row["seconds"] > 0.0 and row["source"] for row in rows)


def test_the_package_runs_as_a_module_and_returns_2_for_an_unknown_case() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "validation", "Z9"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 2
    assert done.stderr.startswith("no validation case 'Z9'")
