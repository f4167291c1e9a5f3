"""Eighty mutants in every run of the tests; more by `python -m tests.fuzz`."""

from __future__ import annotations

import random
import tomllib
from argparse import Namespace
from collections import Counter
from pathlib import Path

import pytest

from rotorgear.cli.commands import COMMANDS
from tests.fuzz.mutate import option_mutations
from tests.fuzz.runner import MODELS, READERS, mutant, origin_of, run_seed, tasks_of
from tests.fuzz.verbs import ALL, LONG, QUICK, WEIGHTS, drawn
from tests.fuzz.write_toml import toml_text


@pytest.mark.parametrize("first", range(0, 100, 20))
def test_mutants_give_finite_results_or_a_sentence(first: int, tmp_path: Path) -> None:
    # Loaded teeth take up to half a minute for each mutant: `python -m tests.fuzz` has them.
    seeds = [seed for seed in range(first, first + 20) if "tooth_fe" not in mutant(seed)[1]]
    found = [finding for seed in seeds for finding in run_seed(seed, QUICK, tmp_path)[0]]
    assert found == []


@pytest.mark.parametrize("kind", READERS)
def test_files_with_bytes_changed_are_read_or_refused(kind: str, tmp_path: Path) -> None:
    for seed in range(4):
        name, data = origin_of(kind, seed)
        path = tmp_path / f"whole{Path(name).suffix}"
        path.write_bytes(data)
        READERS[kind](path, name)
    assert [found for seed in range(24) for found in run_seed(seed, {}, tmp_path, kind=kind)[0]] == []


def test_lines_of_options_leave_nothing_half_written(tmp_path: Path) -> None:
    quick = ("check", "modal", "gear", "static", "sensors", "schema", "import", "export", "new")
    seeds = [seed for seed in range(200) if option_mutations(seed)[0] in quick][:25]
    assert [found for seed in seeds for found in run_seed(seed, {}, tmp_path, kind="options")[0]] == []


def test_options_of_all_commands_are_drawn_and_all_counts_are_run() -> None:
    drawn_commands = {option_mutations(seed)[0] for seed in range(600)}
    assert {one.name for one in COMMANDS} - drawn_commands == {"view", "validate"}
    tasks = tasks_of(Namespace(files=None, seed=5, share=1.0, kind=None))
    counts = Counter(kind for kind, _ in tasks)
    assert counts["options"] == 600
    assert sum(count for kind, count in counts.items() if kind != "options" and not kind.startswith("long")) == 2000
    assert all(counts[f"long {verb}"] == 60 for verb in LONG)
    assert min(seed for _, seed in tasks) == 5


def test_a_model_is_written_as_it_was_read() -> None:
    for path in MODELS:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
        assert tomllib.loads(toml_text(data)) == data


def test_the_same_seed_gives_the_same_mutant() -> None:
    seed = random.Random(1).randrange(10**6)
    assert mutant(seed) == mutant(seed)


def test_a_seed_draws_the_quick_verbs_and_one_more() -> None:
    rows = [drawn(seed) for seed in range(400)]
    assert all(len(row) == len(QUICK) + 1 and row.items() >= QUICK.items() for row in rows)
    assert set(WEIGHTS) == set(ALL) - set(QUICK)
    assert all(drawn(seed).keys() == row.keys() for seed, row in enumerate(rows[:20]))
