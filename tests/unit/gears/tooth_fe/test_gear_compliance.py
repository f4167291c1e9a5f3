"""Compliance of a gear's teeth: reciprocity, closed forms of the body, and the store on disk."""

from __future__ import annotations

import math
import multiprocessing as mp
import os
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rotorgear.gears.tooth_fe import compliance_model
from rotorgear.gears.tooth_fe.compliance_model import (
    ComplianceKey,
    cached,
    compliance_key,
    forget,
    gear_compliance,
    pitch_of,
)
from rotorgear.gears.tooth_fe.gear_compliance import GearCompliance, chained
from rotorgear.gears.tooth_fe.sector import Sector
from rotorgear.gears.tooth_fe.settings import ToothFe
from tests.unit.gears.tooth_pairs import COARSE, helical, pair, spur

NU = 0.3


def key_of(body: str = "rim", *, space: bool = False, bore: float = 40e-3, gear: int = 0) -> ComplianceKey:
    teeth = helical() if space else spur()
    g = (teeth.first, teeth.second)[gear]
    fe = ToothFe(body=body, size=COARSE if space else None)  # type: ignore[arg-type]
    return compliance_key(g, fe, NU, teeth.width, bore, space=space)


def sector_of(key: ComplianceKey) -> Sector:
    return compliance_model.sector_of(key, pitch_of(key)[1])


@pytest.mark.parametrize("space", [False, True])
def test_the_flexibility_of_a_tooth_is_symmetric_and_positive(space: bool) -> None:
    key = key_of(space=space)
    G, _ = chained(sector_of(key), 7, 1, ring=False)
    own = G[1]
    assert np.abs(own - own.T).max() <= 1e-10 * np.abs(own).max()
    assert np.linalg.eigvalsh(own)[0] > 0.0


def test_neighbours_on_a_ring_answer_each_other() -> None:
    key = key_of("ring")
    G, asymmetry = chained(sector_of(key), key.geometry.teeth, 3, ring=True)
    for o in range(4):
        assert np.abs(G[3 + o] - G[3 - o].T).max() <= 1e-11 * np.abs(G).max()
    assert asymmetry <= 1e-11


def test_a_long_arc_held_at_its_ends_is_a_ring_for_its_middle_tooth() -> None:
    sector = sector_of(key_of())
    ring = chained(sector, 34, 1, ring=True)[0]
    arc = chained(sector, 21, 1, ring=False)[0]
    assert np.abs(arc - ring).max() <= 1e-6 * np.abs(ring).max()


def test_all_teeth_loaded_alike_twist_a_ring_as_the_closed_form_says() -> None:
    found = []
    for bore in (40e-3, 55e-3):
        key = key_of("ring", bore=bore)
        z = key.geometry.teeth
        G = chained(sector_of(key), z, (z - 1) // 2, ring=True)[0]
        # With an even number of teeth the one across is met from one side only.
        across = chained(sector_of(key), z, z // 2, ring=True)[0][0]
        found.append(float((G.sum(axis=0) + across).mean()))
    # u = r_b phi with a torque z r_b over a disc between the two radii, phi = z r_b (1/r_1^2 - 1/r_2^2)/(4 pi G).
    r_b = key_of().geometry.base_radius
    shear = 0.5 / (1.0 + NU)
    exact = 34 * r_b**2 * (1.0 / 8.0**2 - 1.0 / 11.0**2) / (4.0 * math.pi * shear)
    assert found[0] - found[1] == pytest.approx(exact, rel=2e-3)


@pytest.mark.parametrize("space", [False, True])
def test_the_condensed_pitch_is_symmetric_and_positive(space: bool) -> None:
    stiffness = sector_of(key_of(space=space)).stiffness
    assert np.array_equal(stiffness, stiffness.T)
    assert np.linalg.eigvalsh(stiffness)[0] > 0.0  # the held inner circle leaves no rigid-body motion


def test_the_unit_of_a_gear_does_not_matter() -> None:
    one = compliance_key(spur().first, ToothFe(), NU, 54e-3, 0.0, space=True)
    large = pair()
    ten = replace(large.first, normal_module=50e-3)
    assert compliance_key(ten, ToothFe(), NU, 540e-3, 0.0, space=True) == one


def small() -> GearCompliance:
    rng = np.random.default_rng(0)
    return GearCompliance(rng.random((3, 2, 2)), rng.random(2), np.zeros(1), 1.0, 2.0, 3.0, 4, 1e-16)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("ROTORGEAR_CACHE", str(tmp_path))
    forget()
    return tmp_path


def test_a_stored_compliance_is_read_and_not_computed(folder: Path) -> None:
    cached("key", small)
    forget()
    found = cached("key", lambda: pytest.fail("computed again"))
    assert np.array_equal(found.flexibility, small().flexibility)
    assert found.unknowns == 4
    assert [path.suffix for path in folder.iterdir()] == [".npz"]


@pytest.mark.parametrize("damage", ["cut", "garbage", "flipped", "empty"])
def test_a_damaged_entry_is_computed_anew(folder: Path, damage: str) -> None:
    cached("key", small)
    forget()
    file = next(folder.iterdir())
    content = bytearray(file.read_bytes())
    if damage == "flipped":
        content[200] ^= 0xFF
    file.write_bytes({"cut": content[:100], "garbage": b"no zip", "flipped": bytes(content), "empty": b""}[damage])
    calls = []
    found = cached("key", lambda: calls.append(1) or small())
    assert calls == [1]
    assert np.array_equal(found.flexibility, small().flexibility)


def test_other_sources_do_not_see_the_entry(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cached("key", small)
    forget()
    monkeypatch.setattr(compliance_model, "MAKERS", ("gears/geometry/pair.py",))
    calls: list[int] = []
    cached("key", lambda: calls.append(1) or small())
    assert calls == [1]


def test_a_folder_that_cannot_be_written_keeps_nothing_and_says_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("in the way")
    monkeypatch.setenv("ROTORGEAR_CACHE", str(blocked))
    forget()
    assert cached("key", small).unknowns == 4


def _work(folder: str, barrier: Any, answers: Any) -> None:
    os.environ["ROTORGEAR_CACHE"] = folder
    forget()
    barrier.wait(30)
    for number in range(25):
        name = f"key {number % 3}"
        forget()
        answers.put(float(cached(name, small).flexibility.sum()))


def test_several_processes_share_the_store(tmp_path: Path) -> None:
    context = mp.get_context("spawn")
    barrier = context.Barrier(3)
    answers = context.Queue()
    workers = [context.Process(target=_work, args=(str(tmp_path), barrier, answers)) for _ in range(3)]
    for worker in workers:
        worker.start()
    found = {answers.get(timeout=60) for _ in range(75)}
    for worker in workers:
        worker.join(30)
        assert worker.exitcode == 0
    assert found == {float(small().flexibility.sum())}
    assert not [path for path in tmp_path.iterdir() if path.suffix != ".npz"]


def _computed_at_once(folder: str, barrier: Any, answers: Any) -> None:
    """Compute the teeth of a gear as soon as another process, too, has found nothing in the folder."""
    os.environ["ROTORGEAR_CACHE"] = folder
    forget()
    key = key_of(gear=1)

    def compute() -> GearCompliance:
        barrier.wait(30)
        return gear_compliance(key, fresh=True)

    answers.put(cached(key, compute).flexibility.tobytes())


def test_two_processes_on_a_cold_cache_end_with_one_entry_and_the_same_teeth(folder: Path) -> None:
    context = mp.get_context("spawn")
    barrier = context.Barrier(2)
    answers = context.Queue()
    workers = [context.Process(target=_computed_at_once, args=(str(folder), barrier, answers)) for _ in range(2)]
    for worker in workers:
        worker.start()
    first, second = (answers.get(timeout=60) for _ in workers)
    for worker in workers:
        worker.join(30)
        assert worker.exitcode == 0
    assert first == second
    (entry,) = folder.iterdir()
    assert re.fullmatch(r"gear_[0-9a-f]{32}\.npz", entry.name)
    forget()
    calls: list[int] = []
    kept = cached(key_of(gear=1), lambda: calls.append(1) or small())
    assert calls == []
    assert kept.flexibility.tobytes() == first


def test_a_gear_is_kept_under_the_name_of_all_that_it_depends_on() -> None:
    keys = [key_of(), key_of(gear=1), key_of("ring"), key_of("ring", bore=41e-3), key_of(space=True)]
    assert len({repr(key) for key in keys}) == len(keys)
    assert gear_compliance(key_of()).unknowns > 1000
