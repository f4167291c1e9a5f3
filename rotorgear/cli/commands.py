"""All commands: each a verb, what becomes of its result, and what is the command's own. `rotorgear --help` reads nothing else."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

from typer.core import TyperGroup

from rotorgear.cli.command import Command
from rotorgear.cli.old_options import current
from rotorgear.cli.options import Option, axes_of
from rotorgear.cli.verb import REQUIRED
from rotorgear.files.read import noting_inputs


def _frequencies(path: Path) -> list[float]:
    import rotorgear as rg

    return [line.frequency_hz for line in rg.read_rig_lines(path)]


def _bounds(texts: list[str]) -> dict[str, list[str]]:
    from rotorgear.cli.options import pairs_of

    pairs = pairs_of("--bounds", texts, "NAME=LOW:HIGH such as 'tip_relief=0 um:60 um'")
    return {name: text.split(":") for name, text in pairs.items()}


def _written_to(text: str) -> Option:
    return Option(text, "path", flags=("-o", "--output"))


_LAWS = Option("Also list the operating points of bearings and elements with force laws.", "flag")
_RIG = Option("Measured frequencies of a rig (CSV).", "path", None)
_SPECTRUM = Option("List the lines in the spectrum of this history.", "text")
_OVER = Option(
    "Map over 'torque=500 N m:2000 N m:4' and 'misalignment=-20 um:20 um:5' (first, last, how many; or a list with colons); "
    "given twice, or both with a comma between.",
    "texts",
    REQUIRED,
    read=axes_of,
)

_GROUPS = {
    "Model": (
        Command(
            "new",
            "Write a model file to change, as a copy of a shipped one",
            options={"path": Option(shown="FILE")},
            shows=(),
            body="bodies.new",
        ),
        Command("models", "List the models that come with rotorgear", shows=(), body="bodies.models"),
        Command("check", "What a model file describes, and what is wrong in it"),
        Command(
            "view",
            "A window with the gearbox and its moving modes",
            ("view", "modal"),
            (),
            body="bodies.view",
            hidden=("model", "fmax", "only", "pruning", "error_estimate", "shapes"),
            options={"mode": Option("Mode to begin with, counted from 1.", default=1, least=1)},
            needs={"pyvista": "A window"},
        ),
        Command(
            "app",
            "A page to click: numbers, modes that move, diagrams, report",
            (),
            (),
            {
                "model": Option(
                    "Model file (TOML); its changes are written back by Save.", "path", REQUIRED, shown="MODEL"
                ),
                "port": Option("Port on this machine; 0: any that is free.", "int", 0, least=0),
                "no_browser": Option("Print the address and open no browser.", "flag"),
            },
            positional=("model",),
            needs={"nicegui": "The page", "tomlkit": "The page", "matplotlib": "The page", "jinja2": "The page"},
            body="bodies.app",
        ),
        Command(
            "report",
            "One page about a model, with pictures (HTML)",
            options={"output": Option("The page to write (HTML).", "path", Path("report.html"), ("-o", "--output"))},
            needs={"jinja2": "A report", "matplotlib": "A report"},
            kept_beside="output",
            body="bodies.report",
        ),
        Command(
            "accuracy",
            "Error against run time over finer and finer meshes",
            shows=("json", "plot"),
            options={
                "modes": Option(least=1),
                "finest": Option(least=1),
                "reference": Option(
                    "Natural frequencies to compare with (CSV; default: the model's own finest).",
                    "path",
                    read=_frequencies,
                ),
            },
            body="bodies.accuracy",
        ),
    ),
    "Linear": (
        Command(
            "modal",
            "Natural frequencies and mode shapes, at rest or at a speed",
            shows=("json", "xlsx", "save", "plot", "vtk", "uff"),
            hidden=("error_estimate", "shapes"),
            options={
                "rig": _RIG,
                "plot": Option(
                    "Render the modes of --shapes: the first to a .png, or all of them into a folder.", "path"
                ),
                "tolerance": Option("Largest relative difference of a match with the rig.", "float", 0.05),
                "energies": Option("Also list the energy shares of each mode by part.", "flag"),
                "laws": _LAWS,
                "shapes": Option(
                    "Modes for --vtk, --plot and --uff, such as 1,6,9-12 (default: the six lowest, --uff all).", "text"
                ),
            },
            table=("energies", "laws"),
            body="bodies.modal",
        ),
        Command(
            "campbell",
            "Modes over speed: crossings, margins, whirl, stability",
            shows=("json", "xlsx", "save", "plot", "vtk"),
            hidden=("error_estimate",),
            options={
                "sidebands": Option(least=0),
                "crossings": Option("Also list all crossings with the lines.", "flag"),
                "laws": _LAWS,
                "colour": Option("Colour of branches in --plot: motion, mesh or damping.", "text", "motion"),
                "log": Option("Logarithmic frequencies in --plot, with all branches.", "flag"),
                "branch": Option("The branch that --vtk writes.", "int", 1, least=1),
            },
            table=("crossings", "laws"),
            picture=("colour", "log"),
        ),
        Command(
            "critical",
            "Critical speeds; with --map over support stiffness",
            shows=("json", "xlsx", "save", "plot"),
            options={
                "damped": Option(flags=("--damped/--undamped",)),
                "laws": _LAWS,
                "map": Option("Also the undamped map over the stiffness of the bearings, which --plot draws.", "flag"),
                "map_shaft": Option("Shaft that excites in the map (default: the input).", "text"),
            },
            table=("laws",),
            body="bodies.critical",
        ),
        Command(
            "static",
            "Deflections, forces, load sharing at the mean load",
            shows=("json", "xlsx", "save", "plot", "vtk"),
            options={"sensitivity": Option("Also list the sensitivities of the load shares of the branches.", "flag")},
            table=("sensitivity",),
        ),
        Command(
            "response",
            "Run-up: forced vibration by order and speed",
            shows=("json", "xlsx", "save", "plot", "vtk", "uff"),
            options={
                "waterfall": Option("Draw spectra over speed to this PNG, SVG or PDF.", "path"),
                "order_map": Option(
                    "Draw levels over speed and frequency, and the overall level, to this file.", "path"
                ),
                "at": Option(
                    "Mesh, bearing or point of --waterfall and --order-map (default: mesh of the largest force).",
                    "text",
                ),
                "laws": _LAWS,
            },
            table=("laws",),
        ),
        Command(
            "frf",
            "Frequency responses between places",
            shows=("json", "xlsx", "save", "plot", "uff"),
            options={"quantity": Option("receptance, mobility or accelerance.", "text", "receptance"), "laws": _LAWS},
            table=("quantity", "laws"),
            picture=("quantity",),
            body="bodies.frf",
        ),
        Command("standards", "Rules of rotor standards with values and verdicts", shows=("json", "xlsx", "save")),
        Command("scatter", "Bands of frequencies and margins where numbers scatter", shows=("json", "xlsx", "plot")),
        Command(
            "optimise",
            "Change numbers so that excitations stay off the modes",
            shows=("json", "save", "plot", "output"),
            options={
                "bounds": Option(shown="ADDRESS=LOW:HIGH"),
                "output": _written_to("Write the model file with the numbers found here."),
            },
        ),
    ),
    "Nonlinear": (
        Command(
            "transient",
            "Motion over time from the static state: backlash, spectra",
            shows=("json", "plot", "vtk"),
            options={
                "start": Option(flags=("--start",)),
                "frames": Option("Instants that --vtk writes.", "int", 120, least=2),
                "spectrum": _SPECTRUM,
                "rig": Option("Put the lines of this rig (CSV) beside those of --spectrum.", "path"),
            },
            needs={"numba": "A transient"},
            body="bodies.transient",
        ),
        Command(
            "sweep",
            "Bifurcations, Lyapunov exponents, response types",
            shows=("json", "plot"),
            options={
                "over": Option(shown="ADDRESS=FROM:TO:COUNT or ADDRESS=VALUE,VALUE,..."),
                "portraits": Option(
                    "Keep the trajectory of the point next to this VALUE (VALUE,VALUE of two parameters); once or more. "
                    "With --plot nine points where not given.",
                    "texts",
                    None,
                ),
            },
            needs={"numba": "A sweep"},
            body="bodies.sweep",
        ),
        Command(
            "orbits",
            "Branches of periodic motions and their stability",
            shows=("json", "save", "plot"),
            options={"over": Option(shown="ADDRESS=FROM:TO")},
            needs={"numba": "A branch of periodic motions"},
        ),
    ),
    "Teeth and parts": (
        Command(
            "gear", "Gear sheet: geometry, measures, contact ratios", shows=("json", "xlsx", "plot"), picture=("mesh",)
        ),
        Command(
            "mesh",
            "Stiffness, transmission error, pressure over a mesh cycle",
            shows=("json", "plot", "vtk"),
            options={
                "harmonics": Option("Mesh orders that are listed.", "int", 5, least=0),
                "at": Option("Position in mesh periods that --vtk writes.", "float", 0.0),
            },
            table=("harmonics",),
        ),
        Command(
            "mesh-map",
            "A mesh cycle over torque and misalignment",
            shows=("json", "plot", "csv"),
            options={"over": _OVER},
        ),
        Command(
            "optimise-flanks",
            "Flank modifications with the least transmission error",
            options={
                "over": _OVER,
                "bounds": Option(read=_bounds, shown="NAME=LOW:HIGH"),
                "tolerance": Option(shown="NAME=SIZE"),
                "weights": Option(least=0),
            },
        ),
        Command("root-stress", "Stress in the tooth roots over a mesh cycle", shows=("json", "plot")),
        Command(
            "bearing",
            "Sheet of one bearing at the gearbox's loads",
            shows=("json", "xlsx", "save", "plot"),
            positional=("name",),
        ),
        Command(
            "casing",
            "Meshes of casings: modes, seats, errors, cost",
            shows=("json", "vtk"),
            options={"modes": Option(least=1)},
        ),
    ),
    "Rig": (
        Command(
            "compare",
            "Modes or responses beside those of a rig",
            ("compare", "compare_shapes", "compare_frf", "compare_orders", "compare_time"),
            ("json", "plot", "output"),
            hidden=("known_to_hz", "samples", "seed", "error_estimate"),
            options={
                "lines": Option("The same as --rig.", "path", shown="RIG"),
                "rig": _RIG,
                "shapes": Option(default=None),
                "frf": Option(default=None),
                "orders": Option(default=None),
                "time": Option(default=None),
                "start": Option(flags=("--start",)),
                "output": _written_to(
                    "Write the frequencies and damping of --ring-down here, as update --rig takes them (CSV)."
                ),
            },
            positional=("lines",),
            body="bodies.compare",
        ),
        Command(
            "sensors",
            "Where to put the sensors of a modal test",
            shows=("json", "save", "output"),
            options={"output": _written_to("Write the table of sensors here (CSV).")},
        ),
        Command(
            "update",
            "Numbers of a model that a rig makes most probable",
            shows=("json", "save", "output"),
            options={"output": _written_to("Write the updated model file here.")},
        ),
    ),
    "Files": (
        Command(
            "import",
            "A gearbox from a REXS file as a model file",
            ("import_rexs",),
            options={
                "path": Option("REXS file, 1.0 to 1.6: XML, JSON or zip.", "path", REQUIRED, shown="FILE"),
                "output": Option("Model file to write, such as model.toml.", "path", REQUIRED, ("-o", "--output")),
                "force": Option("Overwrite the model file if it is there.", "flag"),
            },
            body="bodies.import_rexs",
        ),
        Command(
            "export",
            "The linear system for other programs (.mat, .npz, UFF)",
            ("state_space", "write_matrices"),
            ("json", "uff"),
            hidden=("path",),
            options={
                "inputs": Option(default=None),
                "outputs": Option(default=None),
                "fmax": Option(default=None),
                "state_space": Option("Write A B C D and M D K to this .mat or .npz.", "path"),
                "matrices": Option("Write sparse M C G K to this .npz.", "path"),
                "uff": Option("Write geometry and modes to this universal file.", "path"),
                "modes": Option("Modes of the universal file (default: 12, or to --fmax).", "int"),
            },
            body="bodies.export",
        ),
        Command(
            "schema",
            "The JSON Schema of the model file, for editors",
            options={"json": Option("Write it to this file instead of the terminal.", "path")},
            body="bodies.schema",
        ),
        Command(
            "compile",
            "Compile laws and loops in time ahead of the first run",
            (),
            shows=(),
            body="bodies.compile_ahead",
        ),
        Command(
            "validate",
            "Run the validation cases; exit code 1 where one fails",
            (),
            options={"cases": Option("Cases to run, such as two_disk_rotor (default: all).", "texts", shown="CASE")},
            positional=("cases",),
            body="bodies.validate",
        ),
    ),
}
COMMANDS = tuple(replace(one, group=group) for group, commands in _GROUPS.items() for one in commands)


@cache
def command(name: str) -> Any:
    """A command as typer runs it, made when it is asked for."""
    return next(one for one in COMMANDS if one.name == name).to_typer(_run)


def _run(command: Command, given: dict[str, Any]) -> None:
    """Run a command; what it runs is imported now, and not for help."""
    module, _, name = command.body.rpartition(".")
    with noting_inputs():
        call = import_module("rotorgear.cli.run").Call(command, given)
        getattr(import_module(f"rotorgear.cli.{module}"), name)(call)


class _ByName(Mapping[str, Any]):
    """Name -> command."""

    def __getitem__(self, name: str) -> Any:
        if name not in list(self):
            raise KeyError(name)
        return command(name)

    def __iter__(self) -> Iterator[str]:
        return (one.name for one in COMMANDS)

    def __len__(self) -> int:
        return len(COMMANDS)


class CommandGroup(TyperGroup):
    """The group of all commands; former names and options are told to them by the present ones."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**settings)
        self.commands = _ByName()  # type: ignore[assignment]

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        width = max(len(one.name) for one in COMMANDS)
        for group in dict.fromkeys(one.group for one in COMMANDS):
            with formatter.section(group):
                # Names as wide as the widest of all groups, so that the columns of the groups are in line.
                formatter.write_dl([(f"{one.name:{width}}", one.summary) for one in COMMANDS if one.group == group])

    def shell_complete(self, ctx: Any, incomplete: str) -> list[Any]:
        # Typer's own would make every command to list its name.
        from click.shell_completion import CompletionItem

        return [CompletionItem(one.name, help=one.summary) for one in COMMANDS if one.name.startswith(incomplete)]

    def resolve_command(self, ctx: Any, args: list[str]) -> tuple[Any, Any, list[str]]:
        return super().resolve_command(ctx, current(args))

    def invoke(self, ctx: Any) -> Any:
        # Here and not in main(): typer makes an exit without a word of an interrupt.
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            sys.stderr.write("interrupted; nothing half-written is left behind\n")
            raise SystemExit(130) from None
