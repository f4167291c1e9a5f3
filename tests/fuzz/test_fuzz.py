"""Eighty mutants in every run of the tests; more by `python -m tests.fuzz`."""

from __future__ import annotations

import random
import tomllib
from pathlib import Path

import pytest

from tests.fuzz.runner import MODELS, mutant, run_seed
from tests.fuzz.verbs import ALL, QUICK, WEIGHTS, drawn
from tests.fuzz.write_toml import toml_text


@pytest.mark.parametrize("first", range(0, 100, 20))
def test_mutants_give_finite_results_or_a_sentence(first: int, tmp_path: Path) -> None:
    # Loaded teeth take up to half a minute for each mutant: `python -m tests.fuzz` has them.
    seeds = [seed for seed in range(first, first + 20) if "tooth_fe" not in mutant(seed)[1]]
    found = [finding for seed in seeds for finding in run_seed(seed, QUICK, tmp_path)[0]]
    assert found == []


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
