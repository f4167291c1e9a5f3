"""State spaces and sparse matrices as files that other programs read: MATLAB and Octave (.mat), numpy (.npz)."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sp

from rotorgear.analysis.common.request import check_request, speed_in_si
from rotorgear.analysis.response.mesh import meshed
from rotorgear.analysis.static.mean_state import about_mean
from rotorgear.errors import AnalysisError, RotorgearError
from rotorgear.files.archive import read_arrays
from rotorgear.files.bounds import MATRICES
from rotorgear.files.read import UnreadableError
from rotorgear.files.write import reason_of, written
from rotorgear.model.model import Model
from rotorgear.results.state_space import StateSpace
from rotorgear.system.dofs import dofs_of_nodes

_ENDINGS = (".mat", ".npz")


def require_matrix_name(path: str | Path, endings: tuple[str, ...] = _ENDINGS) -> Path:
    """A name with one of the endings.

    Raises:
        AnalysisError: another ending.
    """
    if Path(path).suffix.lower() not in endings:
        raise AnalysisError(f"{path}: expected a name that ends with {' or '.join(endings)}")
    return Path(path)


def write_state_space(result: StateSpace, path: str | Path) -> Path:
    """Write a state space as .mat (MATLAB 5, which Octave and scipy read) or .npz (numpy).

    Both hold A, B, C, D of x' = A x + B u, y = C x + D u; M, D_v, K, F, P of M q'' + D_v q' + K q = F u, y = P q, with
    P_v q' + P_a q'' beside it where outputs read loads; names and units of inputs and outputs; speed in rad/s, fmax in Hz, and
    the error of the reduction.

    Args:
        result: of `state_space`.
        path: of the file; its ending chooses the format.

    Raises:
        AnalysisError: another ending. WriteError: the file can't be written.
    """
    target = require_matrix_name(path)
    A, B, C, D = result.first_order()
    values: dict[str, Any] = {
        "A": A,
        "B": B,
        "C": C,
        "D": D,
        "M": result.mass_matrix,
        "D_v": result.velocity_terms,
        "K": result.stiffness_matrix,
        "F": result.input_matrix,
        "P": result.output_matrix,
        "speed_rad_s": result.speed,
        "fmax_hz": result.fmax,
        "reduction_error": result.reduction_error,
    }
    if np.any(result.velocity_output) or np.any(result.acceleration_output):
        values |= {"P_v": result.velocity_output, "P_a": result.acceleration_output}
    names = {key: getattr(result, key) for key in ("inputs", "outputs", "input_units", "output_units")}
    with written(target) as scratch:
        stream = BytesIO()
        if target.suffix.lower() == ".mat":
            from scipy.io import savemat

            cells = {key: np.array(texts, dtype=object) for key, texts in names.items()}
            savemat(stream, values | cells, oned_as="column")
        else:
            arrays = values | {key: np.array(texts) for key, texts in names.items()}
            np.savez_compressed(stream, allow_pickle=False, **arrays)
        scratch.write_bytes(stream.getvalue())
    return target


# Name in the file, and what it is in M q'' + (C + W G) q' + K q = f.
NAMES = ("mass", "damping", "gyroscopic", "stiffness", "transform")


def write_matrices(
    model: Model,
    path: str | Path,
    *,
    fmax: float | None = None,
    speed: float | str | None = None,
    elements: int | None = None,
) -> Path:
    """Write M, C, G and K of a model, M q'' + (C + W G) q' + K q = f with W the speed of the input shaft.

    K holds cross-coupled and circulatory terms at the speed. `transform` T gives all displacements of the nodes, x y z tx ty tz
    of each, from the free ones, T q; its rows are named too. C is without modal damping ratios, which belong to modes.

    Args:
        model: any model; contacts are closed, on the flanks that its loads choose.
        path: of the file, with the ending .npz.
        fmax: frequency in Hz that the mesh is refined for; needed without `elements`.
        speed: as in `frf`.
        elements: number of basic elements in each shaft segment, in place of `fmax`.

    Raises:
        AnalysisError: another ending, neither `fmax` nor `elements`. WriteError: the file can't be written.
    """
    target = require_matrix_name(path, (".npz",))
    turns = speed_in_si(speed) or 0.0
    check_request(elements=elements)
    if fmax is None and elements is None:
        raise AnalysisError("matrices need fmax (--fmax), the frequency in Hz that the mesh serves, or elements")
    if fmax is not None and not 0.0 < fmax < float("inf"):
        raise AnalysisError(f"fmax: got {fmax:g}, expected a positive frequency in Hz")
    system = meshed(model, about_mean(model, [turns or None], turns), turns, fmax or 1.0, elements)
    found = system.matrices(turns)
    parts = {
        "mass": system.mass,
        "damping": found.damping,
        "gyroscopic": system.gyroscopic,
        "stiffness": found.stiffness,
        "transform": sp.csc_array(system.dofs.transform[: 6 * len(system.nodes)]),
    }
    values: dict[str, Any] = {"speed_rad_s": turns, "title": model.title or ""}
    for name, matrix in parts.items():
        compressed = sp.csc_array(matrix)
        values |= {
            f"{name}_data": compressed.data,
            f"{name}_indices": compressed.indices,
            f"{name}_indptr": compressed.indptr,
            f"{name}_shape": np.array(compressed.shape),
        }
    names, units = zip(*system.dof_names.items(), strict=True)
    values |= {"dofs": np.array(names), "units": np.array(units), "node_dofs": np.array(dofs_of_nodes(system.nodes))}
    stream = BytesIO()
    np.savez_compressed(stream, allow_pickle=False, **values)
    with written(target) as scratch:
        scratch.write_bytes(stream.getvalue())
    return target


def read_matrices(path: str | Path) -> dict[str, Any]:
    """Read a file of `write_matrices`.

    Args:
        path: of the file.

    Returns:
        "mass", "damping", "gyroscopic", "stiffness" and "transform" as `scipy.sparse.csc_array`; "dofs" and "units" of the
        columns, "node_dofs" of the rows of `transform`, as lists of texts; "speed_rad_s" and "title".

    Raises:
        RotorgearError: no such file, or another one.
    """
    try:
        stored = read_arrays(path, MATRICES.most_bytes)
        found: dict[str, Any] = {
            name: sp.csc_array(
                tuple(stored[f"{name}_{part}"] for part in ("data", "indices", "indptr")),
                shape=tuple(int(count) for count in stored[f"{name}_shape"]),
            )
            for name in NAMES
        }
        for name in NAMES:
            found[name].check_format()  # scipy trusts the indices of an array that it is given
        found |= {name: [str(text) for text in stored[name]] for name in ("dofs", "units", "node_dofs")}
        return {**found, "speed_rad_s": float(stored["speed_rad_s"]), "title": str(stored["title"])}
    except UnreadableError as error:
        raise RotorgearError(f"{path}: no file of matrices: {error.reason}") from None
    except (ValueError, KeyError, TypeError) as error:
        raise RotorgearError(f"{path}: no file of matrices: {reason_of(error)}") from None
