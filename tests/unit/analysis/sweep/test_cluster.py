"""Sweeps over workers of a dask scheduler: the result of local threads, refusals in a sentence, and workers that die."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

import rotorgear as rg
from rotorgear.analysis.sweep import cluster as clusters
from rotorgear.analysis.sweep.blocks import run_blocks
from rotorgear.cli.main import app
from rotorgear.cpu import timed
from rotorgear.errors import AnalysisError, MissingExtraError
from rotorgear.version import VERSION
from tests.unit.analysis.sweep.test_sweep import PAIR, ROOT, SHORT, same

distributed = pytest.importorskip("distributed")
OVER = {"operation.speed": "3000 rpm:9000 rpm:70"}
ROLES = ("client", "scheduler", "worker")


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    """Two workers as threads of this process."""
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=False, dashboard_address=":0") as own,
        distributed.Client(own, set_as_default=False) as found,
    ):
        yield found


def test_workers_give_the_result_of_threads_and_progress_goes_on(client: Any) -> None:
    seen = []
    with rg.cluster(client) as cluster:
        result = rg.sweep(
            rg.load(PAIR), OVER, executor=cluster, progress=lambda f, text: seen.append((f, text)), **SHORT
        )
    assert same(result, rg.sweep(rg.load(PAIR), OVER, **SHORT))
    # The last block, of six runs, is the second one: the first blocks are from all over the sweep.
    assert [text for _, text in seen if "runs" in text] == ["32 of 70 runs", "38 of 70 runs", "70 of 70 runs"]
    assert client.status == "running"  # it is the caller's


def test_an_interrupted_sweep_cancels_its_blocks_and_goes_on_there(client: Any, tmp_path: Path) -> None:
    path = tmp_path / "sweep.h5"

    def stop(fraction: float, text: str) -> None:
        if "runs" in text:
            raise KeyboardInterrupt

    with rg.cluster(client) as cluster:
        with pytest.raises(KeyboardInterrupt):
            rg.sweep(rg.load(PAIR), OVER, executor=cluster, stream=rg.stream(path), progress=stop, **SHORT)
        assert len(list(Path(f"{path}.parts").glob("chunk_*.h5"))) == 1
        again = rg.sweep(rg.load(PAIR), OVER, executor=cluster, stream=rg.stream(path, resume=True), **SHORT)
    assert same(again, rg.sweep(rg.load(PAIR), OVER, **SHORT))


def test_a_block_that_fails_says_so(client: Any) -> None:
    def fail() -> None:
        raise ValueError("a number is missing")

    def refuse() -> None:
        raise AnalysisError("the point can't be run")

    def late() -> None:
        raise TimeoutError("too late")

    with rg.cluster(client) as cluster:
        for function, words in (
            (fail, "failed on a worker: ValueError: a number is missing"),
            (refuse, "^the point can't be run$"),
            (late, "failed on a worker: TimeoutError: too late"),
        ):
            with pytest.raises(AnalysisError, match=words):
                cluster.submit(function).result()
        given_up = cluster.submit(time.sleep, 0.1)
        given_up.cancel()
        with pytest.raises(AnalysisError, match="is gone"):
            given_up.result()


def test_workers_with_another_version_are_refused_at_the_door_and_later(client: Any, monkeypatch: Any) -> None:
    cluster = rg.cluster(client)
    own = clusters.versions()
    assert own["rotorgear"] == rg.__version__
    assert len(own["rotorgear with the source"]) == 8
    with pytest.raises(AnalysisError, match=rf"runs rotorgear {re.escape(VERSION)}, and this computer 9\.0"):
        client.submit(clusters._on_worker, {**own, "rotorgear": "9.0"}, abs, -1).result()
    monkeypatch.setattr(clusters, "versions", lambda: {**own, "numba": "0.1"})
    with pytest.raises(
        AnalysisError, match=rf"the worker .* runs numba {own['numba']}, and this computer 0\.1: install"
    ):
        rg.cluster(client)
    assert clusters.difference(own, {}) == f"runs Python none, and this computer {own['Python']}"
    cluster.close()


def test_a_scheduler_without_workers_is_refused() -> None:
    with (
        distributed.LocalCluster(n_workers=0, processes=False, dashboard_address=":0") as own,
        distributed.Client(own, set_as_default=False) as empty,
        pytest.raises(AnalysisError, match=r"no worker has joined the scheduler at .*dask worker"),
    ):
        rg.cluster(empty, timeout=0.2)


@pytest.mark.parametrize(
    ("address", "words"),
    [
        ("tcp://127.0.0.1:9", "no dask scheduler answers at tcp://127.0.0.1:9 within 0.3 s"),
        ("nonsense", "got 'nonsense', expected the address of a dask scheduler"),
        ("letter://a:1", "unknown address scheme"),
        ("local:0", "local:N for N processes"),
        ("local:two", "local:N for N processes"),
    ],
)
def test_addresses_that_lead_nowhere_are_refused(address: str, words: str) -> None:
    with pytest.raises(AnalysisError, match=words):
        rg.cluster(address, timeout=0.3)


def test_the_command_refuses_threads_and_workers_at_once_and_names_the_extra(monkeypatch: Any) -> None:
    command = ["sweep", str(PAIR), "--over", "operation.speed=3000 rpm", "--cluster", "local:2"]
    both = CliRunner().invoke(app, [*command, "--workers", "2"])
    assert "give one of them" in str(both.exception)
    monkeypatch.setitem(sys.modules, "distributed", None)
    missing = CliRunner().invoke(app, command).exception
    assert isinstance(missing, MissingExtraError)
    assert "rotorgear[cluster]" in str(missing)


class Hand:
    """An executor that runs nothing before it is asked, and counts what lies with it."""

    ahead = 3

    def __init__(self) -> None:
        self.lying = 0
        self.most = 0
        self.cancelled = 0

    def submit(self, function: Callable[..., Any], /, *arguments: Any) -> Any:
        self.lying += 1
        self.most = max(self.most, self.lying)
        _, *task = arguments
        return Held(self, timed(lambda: tuple(task)))


class Held:
    def __init__(self, hand: Hand, answer: Any) -> None:
        self.hand = hand
        self.answer = answer

    def result(self) -> Any:
        self.hand.lying -= 1
        return self.answer

    def cancel(self) -> None:
        self.hand.cancelled += 1


def test_no_more_blocks_lie_with_an_executor_than_it_says_and_the_rest_is_cancelled() -> None:
    hand = Hand()
    tasks: Any = [(k, k, k) for k in range(10)]
    assert list(run_blocks(tasks, None, hand)) == tasks
    assert (hand.most, hand.lying, hand.cancelled) == (3, 0, 0)
    with closing(run_blocks(tasks, None, hand)) as found:
        assert next(found) == tasks[0]
    assert hand.cancelled >= 2


def start(*arguments: str, path: str) -> subprocess.Popen[bytes]:
    """A command of dask that runs until it is stopped."""
    environment = {**os.environ, "PYTHONPATH": path}
    command = [sys.executable, "-m", "dask", *arguments]
    return subprocess.Popen(command, env=environment, cwd=path, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


@pytest.mark.long
def test_processes_of_other_sources_are_refused_and_a_lost_scheduler_is_told(tmp_path: Path) -> None:
    (tmp_path / "rotorgear").mkdir()
    (tmp_path / "rotorgear" / "__init__.py").write_text('__version__ = "0.0.9"\n', encoding="utf-8")
    note = tmp_path / "scheduler.json"
    files = ["--scheduler-file", str(note), "--no-dashboard"]
    started = [start("scheduler", "--port", "0", *files, path=str(ROOT))]
    try:
        worker = [*files, "--nthreads", "1", "--no-nanny"]
        started.append(start("worker", *worker, path=str(tmp_path)))
        while not note.is_file():
            time.sleep(0.1)
        with distributed.Client(scheduler_file=str(note), set_as_default=False) as client:
            address = client.scheduler.address
            client.wait_for_workers(1)
            with pytest.raises(AnalysisError, match=r"runs rotorgear 0\.0\.9, and this computer"):
                rg.cluster(address)
            started.pop().terminate()
            while client.nthreads():
                time.sleep(0.1)
            started.append(start("worker", *worker, path=str(ROOT)))
            client.wait_for_workers(1)
        with rg.cluster(address) as cluster:
            whole = rg.sweep(rg.load(PAIR), OVER, executor=cluster, **SHORT)
            assert same(whole, rg.sweep(rg.load(PAIR), OVER, **SHORT))
            waiting = cluster.submit(time.sleep, 60)
            started[0].kill()
            with pytest.raises(AnalysisError, match="is gone"):
                waiting.result()
    finally:
        for process in started:
            process.kill()
            process.wait()


@pytest.mark.long
@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_two_processes_end_with_the_same_data_although_a_worker_dies(tmp_path: Path) -> None:
    over = {"operation.speed": "3000 rpm:9000 rpm:320"}
    path = tmp_path / "sweep.h5"
    killed = []
    with rg.cluster("local:2") as cluster:
        assert cluster.threads == 2

        def kill(fraction: float, text: str) -> None:
            if "runs" in text and not killed:
                killed.append(next(iter(cluster.client.run(os.getpid).values())))
                os.kill(killed[0], signal.SIGTERM)
            elif text.startswith("192"):
                raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt):
            rg.sweep(rg.load(PAIR), over, executor=cluster, stream=rg.stream(path), progress=kill, **SHORT)
        again = rg.sweep(rg.load(PAIR), over, executor=cluster, stream=rg.stream(path, resume=True), **SHORT)
        with pytest.raises(AnalysisError, match="ended 4 workers at local:2, one after the other"):
            cluster.submit(os._exit, 1).result()
    assert killed
    assert same(again, rg.sweep(rg.load(PAIR), over, **SHORT))


@pytest.mark.long
def test_the_command_prints_the_same_table(tmp_path: Path) -> None:
    command = [
        "sweep",
        str(PAIR),
        "--over",
        "operation.speed=3000 rpm:9000 rpm:70",
        "--discard",
        "40",
        "--sample",
        "40",
    ]
    outputs = [CliRunner().invoke(app, [*command, *more]).output for more in ([], ["--cluster", "local:2"])]
    tables = [[line for line in text.splitlines() if " s; " not in line] for text in outputs]
    assert len(tables[0]) > 60
    assert tables[0] == tables[1]


def test_tls_takes_the_certificates_of_dasks_settings_and_refuses_without(monkeypatch: pytest.MonkeyPatch) -> None:
    import dask.config
    import distributed.comm

    asked = []

    async def connect(address: str, **arguments: Any) -> Any:
        asked.append((address, arguments))
        raise OSError

    with pytest.raises(AnalysisError, match=r"cluster: got 'tls://host:8786', expected .*TLS"):
        rg.cluster("tls://host:8786", timeout=0.2)
    made = object()
    monkeypatch.setattr(
        distributed.Security, "get_tls_config_for_role", lambda self, role: {"ca_file": self.tls_ca_file}
    )
    monkeypatch.setattr(distributed.Security, "_get_tls_context", lambda self, tls, purpose: made, raising=False)
    monkeypatch.setattr(distributed.comm, "connect", connect)
    with (
        dask.config.set({"distributed.comm.tls.ca-file": "ca.pem", "distributed.comm.require-encryption": True}),
        pytest.raises(AnalysisError, match="no dask scheduler answers at tls://host:8786"),
    ):
        rg.cluster("tls://host:8786", timeout=0.2)
    ((address, arguments),) = asked
    assert address == "tls://host:8786"
    assert arguments["require_encryption"]
    assert arguments["ssl_context"] is made


@pytest.mark.long
@pytest.mark.skipif(shutil.which("openssl") is None, reason="makes its certificate by openssl")
def test_a_scheduler_that_asks_for_certificates_gets_those_of_dasks_settings(tmp_path: Path) -> None:
    import dask

    key = tmp_path / "key.pem"
    certificate = tmp_path / "certificate.pem"
    named = ["-keyout", str(key), "-out", str(certificate), "-subj", "/CN=localhost"]
    command = ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", *named]
    subprocess.run(command, check=True, capture_output=True)
    own = {f"tls_{role}_{part}": str(path) for role in ROLES for part, path in (("cert", certificate), ("key", key))}
    security = distributed.Security(tls_ca_file=str(certificate), require_encryption=True, **own)
    settings = {"distributed.comm.tls.ca-file": str(certificate), "distributed.comm.require-encryption": True}
    for part, path in (("cert", certificate), ("key", key)):
        settings[f"distributed.comm.tls.client.{part}"] = str(path)
    few = {"operation.speed": "3000 rpm:9000 rpm:5"}
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, protocol="tls://", security=security, dashboard_address=":0"
    ) as running:
        address = running.scheduler_address
        assert address.startswith("tls://")
        with pytest.raises(AnalysisError, match=r"TLS|no dask scheduler answers"):
            rg.cluster(address, timeout=2.0)
        with dask.config.set(settings), rg.cluster(address) as cluster:
            whole = rg.sweep(rg.load(PAIR), few, executor=cluster, **SHORT)
    assert same(whole, rg.sweep(rg.load(PAIR), few, **SHORT))
