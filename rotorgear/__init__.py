"""rotorgear: finite-element rotor-gear analysis.

    import rotorgear as rg
    model = rg.load("models/split_torque.toml")
    result = rg.modal(model, fmax=5000.0)

The public names stand in `__init__.pyi` beside this file and are loaded when they are first used: importing the package costs
nothing.
"""

from rotorgear.drawing import found_by
from rotorgear.lazy import attach
from rotorgear.version import VERSION

__version__ = VERSION

# Names of 0.1; verbs have the names of the commands now.
_FORMER = {
    "describe_model": "check",
    "critical_speeds": "critical",
    "frequency_response": "frf",
    "gear_sheet": "gear",
    "mesh_analysis": "mesh",
    "json_schema": "schema",
    "accuracy_ladder": "convergence_study",
    "transient_ladder": "transient_convergence_study",
    "mesh_ladder": "mesh_convergence_study",
    "sweep_ladder": "sweep_convergence_study",
    "AccuracyLadder": "ConvergenceStudy",
    "SweepLadder": "SweepConvergenceStudy",
}
__getattr__, __dir__, __all__ = attach(__name__, __file__, _FORMER)
__all__ += ["__version__"]


def _pages():  # type: ignore[no-untyped-def]
    from rotorgear.page.notebook import shown

    return shown


found_by(lambda kind: getattr(__getattr__("plot"), kind, None), _pages)
