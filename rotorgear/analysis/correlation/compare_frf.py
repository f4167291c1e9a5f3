"""Compare measured frequency responses with those of a model, pair by pair of places.

    FRAC = |sum H_rig^* H_model|^2 / (sum |H_rig|^2 sum |H_model|^2)      (Heylen and Lammens 1996)

at the frequencies of the rig.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.response.frequency_response import frf
from rotorgear.analysis.rig.frf_file import MeasuredFrf, read_rig_frf
from rotorgear.analysis.rig.mac import frac
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.results.frf_comparison import FrfComparison, FrfMatch


@recorded
def compare_frf(
    model: Model,
    frf: str | Path | MeasuredFrf,
    *,
    points: str | Path | None = None,
    speed: float | str | None = None,
    modal_damping: float = 0.0,
    accuracy: float | None = None,
    elements: int | None = None,
    progress: Progress = silent,
) -> FrfComparison:
    """Put measured frequency responses beside those of a model.

    Args:
        model: the model, with its damping.
        frf: measured frequency responses: a universal file (dataset 58 or 58b); in Python also what it holds.
        points: as in `compare_shapes`.
        speed: as in `compare`.
        modal_damping: as in `frf`.
        accuracy: as in `frf`.
        elements: as in `frf`.
        progress: callable that is told fraction and step.

    Returns:
        FRAC of each pair of places, with and without phase, and the ratio of sizes.

    Raises:
        ModelError: a file that can't be read. AnalysisError: no frequency responses, places that the model has not.
    """
    given = frf if isinstance(frf, MeasuredFrf) else read_rig_frf(frf, points, model)
    inputs = list(dict.fromkeys(given.references))
    outputs = list(dict.fromkeys(given.responses))
    found = _model_frf(
        model,
        given.frequency_hz,
        inputs=inputs,
        outputs=outputs,
        speed=speed,
        modal_damping=modal_damping,
        accuracy=accuracy,
        elements=elements,
        progress=progress,
    )
    computed = np.array(
        [
            found.receptance[:, outputs.index(o), inputs.index(i)]
            for o, i in zip(given.responses, given.references, strict=True)
        ]
    )
    matches = []
    for response, reference, rig, own in zip(
        given.responses, given.references, given.receptance, computed, strict=True
    ):
        sizes = (float(np.linalg.norm(rig)), float(np.linalg.norm(own)))
        ratio = sizes[1] / sizes[0] if sizes[0] > 0.0 else float("nan")
        matches.append(FrfMatch(response, reference, frac(rig, own), frac(np.abs(rig), np.abs(own)), ratio))
    return FrfComparison(
        model=model,
        frequency_hz=given.frequency_hz,
        pairs=tuple(matches),
        measured=given.receptance,
        computed=computed,
        damping_ratio=found.damping_ratio,
        dofs=found.dofs,
        left_out=found.left_out,
        warnings=(*given.notes, *found.warnings),
        method="FRAC at the frequencies of the rig",
    )


# The verb's own argument is called as its option, --frf.
_model_frf = frf
