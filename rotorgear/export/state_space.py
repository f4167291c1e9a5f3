"""State spaces and matrices as files that other programs read: MATLAB and Octave (.mat), numpy (.npz)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.export.files import replacing
from rotorgear.results.state_space import StateSpace

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

    Both hold A, B, C, D of x' = A x + B u, y = C x + D u; M, D_v, K, F, P of M q'' + D_v q' + K q = F u, y = P q; names and
    units of inputs and outputs; speed in rad/s, fmax in Hz, and the error of the reduction.

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
    names = {
        "inputs": result.inputs,
        "outputs": result.outputs,
        "input_units": result.input_units,
        "output_units": result.output_units,
    }
    with replacing(target) as scratch:
        if target.suffix.lower() == ".mat":
            from scipy.io import savemat

            cells = {key: np.array(texts, dtype=object) for key, texts in names.items()}
            with open(scratch, "wb") as stream:
                savemat(stream, {**values, **cells}, oned_as="column")
        else:
            with open(scratch, "wb") as stream:
                arrays = {**values, **{key: np.array(texts) for key, texts in names.items()}}
                np.savez_compressed(stream, allow_pickle=False, **arrays)
    return target
