"""Lines of a spectrum that no bin meets, against what excites."""

from __future__ import annotations

import math

import numpy as np
import pytest

import rotorgear as rg
from tests.models import spur_pair

MESH = 24 * 1500.0 / 60.0


@pytest.mark.parametrize("time", [0.1003, 0.1007])
def test_a_line_between_two_bins_is_found_where_it_is_and_as_high(time: float) -> None:
    model = spur_pair(meshes__pair__transmission_error=[{"harmonic": 1, "amplitude": "4 um"}])
    result = rg.transient(model, time=time, discard=0.15, steps=100, records=20, method="newmark", error_estimate=False)
    lines = rg.spectral_lines(result, "force pair")
    strongest = int(np.argmax(lines.amplitude))
    bin_width = 1.0 / time
    assert abs(MESH * time - round(MESH * time)) > 0.15  # of a bin beside the nearest
    assert abs(lines.frequency_hz[strongest] - MESH) < 0.02 * bin_width
    force = result.mesh_force[result.counted, 0]
    assert lines.amplitude[strongest] == pytest.approx(math.sqrt(2.0) * force.std(), rel=0.02)
