"""Pictures of results: `rg.plot.campbell(result, ax=None)`, each named as the kind of result that it draws.

    axes = rg.plot.campbell(rg.campbell(model), colour="damping")
    rg.plot.save(axes, "campbell.png")

A picture of one panel takes `ax`, axes of matplotlib to draw on, and returns them; one of several panels takes `fig`, a figure or
subfigure, and returns its axes. Without them a new figure is made, with a title; no window opens, no file is written, and
pyplot is not touched. The names stand in `__init__.pyi` and are loaded when they are first used.
"""

from rotorgear.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
