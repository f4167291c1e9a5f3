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

__getattr__, __dir__, __all__ = attach(__name__, __file__)
__all__ += ["__version__"]


def _pages():  # type: ignore[no-untyped-def]
    from rotorgear.page.notebook import shown

    return shown


found_by(lambda kind: getattr(__getattr__("plot"), kind, None), _pages)
