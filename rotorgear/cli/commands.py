"""The commands: known by name and by what the help says of them, each imported only when it is called.

A command's function stands in the file of its name. The sentences below are the first of these functions' docstrings, which
`tests/unit/cli/test_commands.py` holds equal: help lists all commands without an import of any.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from importlib import import_module
from keyword import iskeyword
from typing import Any

import typer
from typer.core import TyperGroup

from rotorgear.cli.old_options import with_current_options

HELP = {
    "new": "Write a model file with comments, as a copy of one that comes with rotorgear, to change freely.",
    "models": "List the models that come with rotorgear, to look at and to start from.",
    "import": "Read a gearbox from a REXS file (XML, JSON or zip) into a model file, with a comment for every assumption.",
    "modal": "Natural frequencies and mode shapes; undamped at standstill, or damped and gyroscopic at a --speed.",
    "campbell": "Campbell diagram: modes over speed, excitation lines, crossings, margins, whirl and stability.",
    "critical": "Critical speeds, damped or undamped, of every shaft and mesh order; with --map over support stiffness.",
    "compare": "Compare modes with rig frequencies, shapes, responses or order cuts, and with what chance gives.",
    "sensors": "Place the sensors of a modal test: which places tell the modes apart best, before the test is made.",
    "update": "Update numbers of a model by a rig: most probable values, what the lines teach, and held-out proof.",
    "static": "Deflections, bearing and mesh forces, load sharing of branches and helices, assembly condition of loops.",
    "response": "Run-up: response to unbalances, transmission errors and stiffness variation, by order and speed.",
    "frf": "Frequency responses between points or parts: unit force in, displacement, velocity or acceleration out.",
    "standards": "Amplification, separation margins, vibration, stability, torsion and balance against rules of standards.",
    "transient": "Time response from the static equilibrium: contact forces, transmission error, bearings, spectra.",
    "sweep": "Bifurcation diagram, Lyapunov exponents and response types of a model over its parameters.",
    "orbits": "Periodic motions over a parameter: stable and unstable branches, Floquet multipliers, folds and period doublings.",
    "scatter": "Scatter of uncertain numbers: bands of frequencies, margins and load shares, and which number makes them.",
    "optimise": "Keep excitations away from modes that they excite: numbers of a model within bounds, gradients exact.",
    "check": "Show what a model file describes: speeds, mesh frequencies, torques, contact ratios, masses, dofs, warnings.",
    "gear": "Print the gear sheet: geometry, measures, contact ratios, backlash and stiffness of all teeth.",
    "mesh": "Print stiffness, transmission error, load sharing and pressure of one mesh over its cycle.",
    "bearing": "Sheet of one bearing at the gearbox's own loads: inside, stiffness and damping over speed, whirl threshold.",
    "casing": "Read the meshes of casings: mass, free and held modes, seats, errors of mesh and reduction, cost.",
    "report": "Write one page about a model: drawing, statics, modes, Campbell, rules of standards, teeth, rig, errors, costs.",
    "accuracy": "Convergence study: error against run time and dofs over a series of discretisations, with the measured order.",
    "export": "Write the linear system for other programs: state space (.mat, .npz), sparse matrices, geometry and modes (UFF).",
    "view": "Open a window that shows the gearbox and animates its modes.",
    "schema": "Print the JSON Schema of the model file, for completion and checks in editors.",
    "validate": "Run the validation cases: expected, got, error, dofs, seconds. Exit code 1 where one is out of tolerance.",
}


def function_of(name: str) -> Any:
    """The function of a command; one whose name Python keeps for itself has an underscore behind it, as has its file."""
    own = f"{name}_" if iskeyword(name) else name
    return getattr(import_module(f"rotorgear.cli.{own}"), own)


class Commands(Mapping[str, Any]):
    """Name -> command, made of its function when it is asked for."""

    def __getitem__(self, name: str) -> Any:
        if name not in HELP:
            raise KeyError(name)
        function = function_of(name)
        single = typer.Typer(add_completion=False, rich_markup_mode=None)
        single.command(name)(function)
        return typer.main.get_command(single)

    def __iter__(self) -> Iterator[str]:
        return iter(HELP)

    def __len__(self) -> int:
        return len(HELP)


class CommandGroup(TyperGroup):
    """The group of all commands; they are told former options by their present names."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**settings)
        self.commands = Commands()  # type: ignore[assignment]

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        with formatter.section("Commands"):
            formatter.write_dl(list(HELP.items()))

    def resolve_command(self, ctx: Any, args: list[str]) -> tuple[Any, Any, list[str]]:
        name, command, rest = super().resolve_command(ctx, args)
        return name, command, with_current_options(name or "", rest)

    def invoke(self, ctx: Any) -> Any:
        # Here and not in main(): typer makes an exit without a word of an interrupt.
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            sys.stderr.write("interrupted; nothing half-written is left behind\n")
            raise SystemExit(130) from None
