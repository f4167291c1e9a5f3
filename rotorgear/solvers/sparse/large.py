"""Factorisation of large symmetric positive definite matrices of solids, by the best order and solver that is installed.

What fills a factor of a solid body is the order of elimination. Nested dissection of the graph of nodes (METIS, by
pymetis; Karypis and Kumar, SIAM J. Sci. Comput. 20, 1998) takes a tenth of the time of SuperLU's own minimum degree, and half of
its memory; Pardiso (by pypardiso) orders likewise and is faster again.

Python handles an interrupt only between two of its own steps, and a factorisation is one step that may take a minute. SuperLU and
Pardiso release Python's lock: the work runs in a thread (`watched`), and the main thread waits for it and for Ctrl-C.
"""

from __future__ import annotations

import importlib.util
import os
import sys
import threading
import time
from collections.abc import Callable
from contextvars import copy_context
from typing import Any, Literal, TypeVar

import numpy as np
import scipy.sparse as sp

from rotorgear.errors import AnalysisError
from rotorgear.progress import Progress, silent
from rotorgear.solvers.sparse.factor import symmetric_superlu
from rotorgear.solvers.sparse.nullspace import Solve

T = TypeVar("T")
# Shorter work than this is waited for.
_SHORT = 2.0
_TELL_EVERY = 0.5
# Share at which the progress stops when the forecast was too short.
_MOST = 0.95


def watched(work: Callable[[], T], seconds: float, tell: Callable[[float], None]) -> T:
    """Return or raise what `work()` does; an interrupt returns to the caller at once.

    The thread is a daemon: it ends with the process. A session that goes on lets it compute to its end, and drops the result.

    Args:
        work: compiled code that releases Python's lock.
        seconds: expected duration.
        tell: called with the share that is done, estimated by the clock.
    """
    if seconds < _SHORT or threading.current_thread() is not threading.main_thread():
        return work()
    done: dict[str, Any] = {}
    context = copy_context()

    def run() -> None:
        try:
            done["value"] = context.run(work)
        except BaseException as error:  # raised where it is waited for
            done["error"] = error

    thread = threading.Thread(target=run, daemon=True)
    started = time.perf_counter()
    thread.start()
    while thread.is_alive():
        thread.join(_TELL_EVERY)
        tell(min((time.perf_counter() - started) / seconds, _MOST))
    if "error" in done:
        raise done["error"]
    found: T = done["value"]
    return found


Solver = Literal["pardiso", "metis", "mmd"]
# Seconds and bytes of one factorisation of 139 000 unknowns of quadratic tetrahedra on one core, and the powers of n that other
# sizes follow (36 000 to 369 000 unknowns were measured).
_MEASURED = 139_000
_COST: dict[Solver, tuple[float, float, float, float]] = {
    "pardiso": (3.6, 1.3, 1.0e9, 1.2),
    "metis": (8.4, 1.55, 1.7e9, 1.12),
    "mmd": (65.0, 2.2, 2.8e9, 1.4),
}
# Forecast in seconds above which it is shown before the work starts.
_LONG = 20.0


def best_solver() -> Solver:
    """The best of what is installed."""
    if importlib.util.find_spec("pypardiso"):
        return "pardiso"
    return "metis" if importlib.util.find_spec("pymetis") else "mmd"


def forecast(unknowns: int, solver: Solver) -> tuple[float, float]:
    """Seconds and bytes that one factorisation takes, about.

    The machine and the shape of the body make a factor of two either way.
    """
    seconds, time_power, memory, memory_power = _COST[solver]
    ratio = unknowns / _MEASURED
    return seconds * ratio**time_power, memory * ratio**memory_power


def _factored(A: Any, solver: Solver, order: np.ndarray | None) -> Solve:
    """What gives A⁻¹ B for B (n,) or (n, k)."""
    if solver == "pardiso":
        from pypardiso import PyPardisoSolver

        upper = sp.csr_matrix(sp.triu(A, format="csr"))
        pardiso = PyPardisoSolver(mtype=2)
        pardiso.factorize(upper)

        def by_pardiso(B: np.ndarray) -> np.ndarray:
            return np.asarray(pardiso.solve(upper, np.asfortranarray(B))).reshape(B.shape)

        return by_pardiso
    permuted = A if order is None else A[order][:, order]
    del A
    # Rows of a symmetric matrix are its columns: no copy.
    columns = sp.csc_array((permuted.data, permuted.indices, permuted.indptr), shape=permuted.shape)
    del permuted
    lu: Any = symmetric_superlu(columns, "MMD_AT_PLUS_A" if order is None else "NATURAL")

    def by_superlu(B: np.ndarray) -> np.ndarray:
        if order is None:
            return np.asarray(lu.solve(np.asfortranarray(B)))
        x = np.empty_like(B)
        x[order] = lu.solve(np.asfortranarray(B[order]))
        return x

    return by_superlu


def factor_positive(
    A: Any,
    blocks: int,
    what: str,
    progress: Progress = silent,
    solver: Solver | None = None,
) -> Solve:
    """Factor a symmetric positive definite sparse matrix A; what is returned gives A⁻¹ B for B (n,) or (n, k).

    Args:
        A: (n, n), any sparse format, with the same pattern for all unknowns of a node, which follow each other.
        blocks: unknowns a node.
        what: name of what is factored, for progress and errors.
        progress: called with the forecast before the work starts, then with the share of that time that has passed.
        solver: "pardiso", "metis" or "mmd"; None: the best that is installed.

    Raises:
        AnalysisError: it needs more memory than the machine has.
        ConvergenceError: the matrix is singular.
    """
    solver = solver or best_solver()
    seconds, memory = forecast(A.shape[0], solver)
    cost = f"about {seconds:.0f} s and {memory / 1e9:.1f} GB"
    text = f"{what}: factorisation of {A.shape[0]} unknowns"
    try:
        installed = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):  # the system does not tell
        installed = sys.maxsize
    if memory > installed:
        better = ", or install pymetis: pip install 'rotorgear[casing]'" if solver == "mmd" else ""
        raise AnalysisError(
            f"{what}: a factorisation of {A.shape[0]} unknowns takes {cost}, and this machine has {installed / 1e9:.1f} GB. "
            f"Use a coarser model{better}."
        )
    if seconds > _LONG:
        hint = "; pymetis would take a tenth of it (pip install 'rotorgear[casing]')" if solver == "mmd" else ""
        text += f", {cost}{hint}"
    progress(0.0, text)

    def work() -> Solve:
        return _factored(sp.csr_array(A), solver, nested_dissection(A, blocks) if solver == "metis" else None)

    return watched(work, seconds, lambda share: progress(share, text))


def nested_dissection(A: Any, blocks: int) -> np.ndarray:
    """Order (n,) of elimination by METIS, found on the graph of nodes."""
    import pymetis

    graph = sp.bsr_array(A, blocksize=(blocks, blocks))
    nodes = graph.shape[0] // blocks
    ones = np.ones(len(graph.indices), dtype=np.int8)
    pattern = sp.csr_array((ones, graph.indices, graph.indptr), shape=(nodes, nodes))
    pattern.setdiag(0)
    pattern.eliminate_zeros()
    if hasattr(pymetis, "CSRAdjacency"):
        permutation, _ = pymetis.nested_dissection(pymetis.CSRAdjacency(pattern.indptr, pattern.indices))
    else:  # before 2025
        permutation, _ = pymetis.nested_dissection(xadj=pattern.indptr, adjncy=pattern.indices)
    return (np.asarray(permutation)[:, None] * blocks + np.arange(blocks)).ravel()
