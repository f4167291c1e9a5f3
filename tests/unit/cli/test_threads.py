"""On how many threads linear algebra runs under the command line."""

from __future__ import annotations

import os

import pytest

from rotorgear.cli.start import one_blas_thread

NAMES = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS")


@pytest.mark.parametrize("said", NAMES)
def test_linear_algebra_runs_on_one_thread_unless_the_user_says_otherwise(
    said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in NAMES:
        monkeypatch.setenv(name, "0")  # so that all of them are put back at the end
        monkeypatch.delenv(name)
    monkeypatch.setenv("OPENBLAS_THREAD_TIMEOUT", "20")  # set by the call, too
    one_blas_thread()
    assert os.environ["OPENBLAS_NUM_THREADS"] == os.environ["MKL_NUM_THREADS"] == "1"
    for name in NAMES:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv(said, "2")
    one_blas_thread()
    assert [os.environ.get(name) for name in NAMES] == ["2" if name == said else None for name in NAMES]


@pytest.mark.parametrize("said", [None, "30"])
def test_threads_without_work_sleep_soon_unless_the_user_says_otherwise(
    said: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in (*NAMES, "OPENBLAS_THREAD_TIMEOUT"):
        monkeypatch.setenv(name, said or "1")  # so that all of them are put back at the end
    if said is None:
        monkeypatch.delenv("OPENBLAS_THREAD_TIMEOUT")
    one_blas_thread()
    waits = int(os.environ["OPENBLAS_THREAD_TIMEOUT"])
    assert waits == int(said) if said else waits <= 20
