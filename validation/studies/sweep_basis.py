"""How many modes a sweep of the split-torque gearbox in its casing needs: error of the basis that it would run in.

    python -m validation.studies.sweep_basis

models/split_torque_casing.toml at 16350 rpm without unbalances. Prints modes asked for, coordinates of the basis, and the largest
relative error of the receptances at the contacts up to the highest harmonic that counts, contacts closed and apart. Nothing is
integrated; the sweep itself would take hours.
"""

from __future__ import annotations

from pathlib import Path

import rotorgear as rg
from rotorgear.analysis.sweep.axes import axis_of
from rotorgear.analysis.sweep.request import Request
from rotorgear.analysis.sweep.sweep import ready_points
from rotorgear.progress import silent
from rotorgear.solvers.sparse.factor import single_thread

MODEL = Path(__file__).resolve().parents[2] / "models" / "split_torque_casing.toml"
OVER = {"operation.speed": ["16350 rpm"], "unbalances.*.magnitude": ["0 kg m"]}
MODES = (100, 160)


def main() -> None:
    model = rg.load(MODEL)
    axes = [axis_of(address, values) for address, values in OVER.items()]
    print("modes  coordinates  closed   apart")
    for modes in MODES:
        request = Request("each", 1, 10, 10, 0, None, 1e-4, 1e-3, 1, 1.0, modes, 0.02, None)
        with single_thread(0):
            _, _, failure, _, reduction = ready_points(model, axes, None, request, silent)
        assert reduction is not None, failure
        closed, apart = 100.0 * reduction.closed, 100.0 * reduction.apart
        print(f"{modes:5}  {reduction.coordinates:11}  {closed:4.0f} %  {apart:4.0f} %  up to {reduction.up_to:.0f} Hz")


if __name__ == "__main__":
    main()
