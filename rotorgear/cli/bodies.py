"""Commands that do more than to run one verb and to show its result."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import typer

import rotorgear as rg
from rotorgear.analysis.common.request import share_of
from rotorgear.cli.console import console, progress_bar, say
from rotorgear.cli.options import spelling
from rotorgear.cli.run import Call
from rotorgear.cli.show import numbers_of_modes, show, write_json
from rotorgear.cli.verb import arguments_of
from rotorgear.cpu import cpu_seconds
from rotorgear.errors import AnalysisError, Interrupted
from rotorgear.progress import hearing_forecasts

# Points that --plot of a sweep draws portraits and spectra of.
_PORTRAITS = 9


def modal(call: Call) -> None:
    """Modes, and beside them the lines of a rig."""
    rig = rg.read_rig_lines(call["rig"]) if call["rig"] else ()
    # Refused before anything is computed.
    numbers = numbers_of_modes(call["shapes"])
    if numbers and call["modes"] and max(numbers) >= call["modes"]:
        raise AnalysisError(f"--shapes: there is no mode {max(numbers) + 1}, --modes asks for {call['modes']}")
    if rig:
        share_of(call["tolerance"], "tolerance", "0.05")
    fmax = call["fmax"]
    if rig and call["modes"] is None and fmax is None:
        from rotorgear.analysis.rig.compare import ABOVE_RIG

        fmax = ABOVE_RIG * max(line.frequency_hz for line in rig)
    result = call.result(**({} if fmax is None else {"fmax": fmax}))
    # A number of modes says nothing of where the next one lies; a highest frequency does.
    known_to_hz = None if call["modes"] else fmax
    compared = {"tolerance": call["tolerance"], "known_to_hz": known_to_hz}
    show(call, result, {"comparison": rg.compare(result, rig, **compared)} if rig else None)


def critical(call: Call) -> None:
    """Critical speeds, and with --map their map over the stiffness of the supports."""
    if (call["plot"] or call["map_shaft"]) and not call["map"]:
        raise AnalysisError("--plot and --map-shaft belong to --map; rotorgear campbell --plot draws modes over speed")
    result = call.result()
    chart = None
    if call["map"]:
        chart = call.result("critical_map", **({} if call["map_shaft"] is None else {"shaft": call["map_shaft"]}))
    show(call, result, {"map": chart} if chart else None, drawn=chart)


def transient(call: Call) -> None:
    """A transient, and beside it the lines in a spectrum and those of a rig."""
    if call["rig"] and not call["spectrum"]:
        raise AnalysisError("--rig needs --spectrum: the history whose lines are compared")
    lines = rg.read_rig_lines(call["rig"]) if call["rig"] else ()
    result = call.result(frames=call["frames"] if call["vtk"] else 0)
    beside: dict[str, Any] = {}
    if call["spectrum"]:
        beside["spectrum"] = rg.spectral_lines(result, call["spectrum"])
        if call["rig"]:
            beside["rig"] = rg.compare_spectrum(result, beside["spectrum"], lines)
    show(call, result, beside)


def sweep(call: Call) -> None:
    """A sweep; its pictures want the trajectories of some points."""
    show(call, call.result(portraits=call["portraits"] or (_PORTRAITS if call["plot"] else 0)))


def frf(call: Call) -> None:
    """Frequency responses, as one of three quantities."""
    from rotorgear.results.frequency_response import QUANTITIES

    if call["quantity"] not in QUANTITIES:
        raise AnalysisError(f"--quantity: got '{call['quantity']}', expected one of {', '.join(QUANTITIES)}")
    show(call, call.result())


def accuracy(call: Call) -> None:
    """A convergence study."""
    if call["analysis"] == "sweep" and call["plot"]:
        raise AnalysisError("--plot: the study of a sweep has no picture; --json writes its numbers")
    try:
        result = call.result()
    except Interrupted as stop:
        show(call, stop.result, whole=False)
        raise
    show(call, result)


def compare(call: Call) -> None:
    """A model or its saved modes beside one thing that was measured."""
    if call["rig"] is not None and call["lines"] is not None:
        raise AnalysisError("the rig is given twice: as RIG and as --rig")
    verbs = {"rig": "compare", "shapes": "compare_shapes", "frf": "compare_frf", "orders": "compare_orders"}
    verbs |= {"time": "compare_time"}
    given = {name: verb for name, verb in verbs.items() if call[name] or (name == "rig" and call["lines"])}
    if len(given) != 1:
        raise AnalysisError(
            "give one thing that was measured: rig lines (CSV), --shapes rig.uff, --frf rig.uff, --orders "
            "cuts.csv or --time record.csv"
        )
    ((what, verb),) = given.items()
    if call["points"] and what == "rig":
        raise AnalysisError("--points belongs to --shapes, --frf, --orders or --time: lines have no place")
    if call.saved and what in ("frf", "orders", "time"):
        raise AnalysisError(f"--{what} needs a model file: a saved result has its own frequencies and speeds")
    choices = call.command.choices
    known = arguments_of(verb)
    for name in call.command.arguments:
        if name in choices and name not in ("source", *known) and call.asked(name) is not None:
            raise AnalysisError(f"{spelling(name)} does not go with {'rig lines' if what == 'rig' else f'--{what}'}")
    if call["plot"] and what not in ("shapes", "time"):
        raise AnalysisError("--plot draws the MAC of --shapes, or the record of --time")
    if call["output"] and not call["ring_down"]:
        raise AnalysisError("--output takes the frequencies and damping of --ring-down: give the time of one")
    show(call, call.result(verb, **({"rig": call["rig"] or call["lines"]} if what == "rig" else {})))


def export(call: Call) -> None:
    """The linear system as files of other programs."""
    from rotorgear.export.matrices import require_matrix_name

    state_space = call["state_space"]
    matrices = call["matrices"]
    uff = call["uff"]
    if not (state_space or matrices or uff):
        raise AnalysisError("nothing to write: give --state-space, --matrices or --uff")
    if state_space:
        require_matrix_name(state_space)
        if not call["inputs"] or not call["outputs"] or call["fmax"] is None:
            raise AnalysisError("a state space needs --inputs, --outputs and --fmax")
    if matrices:
        require_matrix_name(matrices, (".npz",))
    if state_space:
        system = call.result("state_space")
        written = rg.write_state_space(system, state_space)
        console().print(system.table())
        write_json(call, system.to_dict())
        say(f"wrote {written}")
    if matrices:
        say(f"wrote {rg.write_matrices(call.source, matrices, **call.arguments('write_matrices'))}")
    if uff:
        asked = {name: call.asked(name) for name in ("speed", "elements")}
        to_fmax = call["fmax"] is not None and call["modes"] is None
        by = {"fmax": call["fmax"]} if to_fmax else {"modes": call["modes"] or 12}
        with progress_bar("modes") as progress:
            modes = rg.modal(call.source, **by, **asked, progress=progress)
        say(f"wrote {rg.write_uff(modes, uff)}")


def report(call: Call) -> None:
    """One page about a model."""
    with call.stream() as stream, progress_bar("report", lines=True) as progress:
        asked = {"output": call["output"]} | call.arguments("report")
        done = rg.report(call.source_path, **asked, stream=stream, progress=progress)
    stream.close()
    if call["json"]:
        write_json(call, done.to_dict())
    say(f"wrote {done.path}, {done.path.stat().st_size / 1e6:.2f} MB")
    for name, reason in done.missing.items():
        say(f"not there: {name}: {reason}")


def view(call: Call) -> None:
    """A window with the modes of a model or of a saved result."""
    rg.view(call.source if call.saved else call.result("modal"), mode=call["mode"] - 1)


def app(call: Call) -> None:
    """A page on this machine in which a model is edited, seen and computed."""
    from rotorgear.app.page import serve

    serve(call["model"], call["port"], browser=not call["no_browser"], say=say)


def new(call: Call) -> None:
    """A model file of one's own, begun as a copy of a shipped one."""
    path = call.source_path
    for written in rg.new(path, **call.arguments("new")):
        say(f"wrote {written}")
    say(f"Next:  rotorgear check {path}")


def models(call: Call) -> None:
    """The models that come with the package."""
    out = console()
    shipped = rg.models()
    width = max(len(model.name) for model in shipped)
    for model in shipped:
        out.print(f"{model.name:{width}}  {model.title}", markup=False, no_wrap=True, overflow="ellipsis")
    out.print("\nTo begin with one of them:  rotorgear new gearbox.toml --source NAME")


def import_rexs(call: Call) -> None:
    """A gearbox of another program as a model file."""
    output = call["output"]
    if output.is_file() and not call["force"]:
        raise AnalysisError(f"{output} is there already; give another name, or --force to overwrite it")
    result = rg.import_rexs(call.source_path, **call.arguments("import_rexs"))
    written = rg.write_model_file(result, output)
    console().print(result.table())
    write_json(call, result.to_dict())
    say(f"wrote {written}\nNext:  rotorgear check {written}")


def schema(call: Call) -> None:
    """The JSON Schema of the model file."""
    import json

    data = rg.schema()
    if call["json"] is None:
        say(json.dumps(data, indent=2))
    else:
        write_json(call, data)
        say(f"wrote {call['json']}")


def compile_ahead(call: Call) -> None:
    """Machine code of all laws and of motions in time, by the shortest runs, which keep it in the cache folder."""
    pair, planetary = (
        rg.load(next(one.path for one in rg.models() if one.name == name)) for name in ("backlash_pair", "planetary")
    )
    going_round = planetary.with_("damping.modal_ratio", 0.0)
    speed = "operation.speed"

    def briefly(model: rg.Model, method: str) -> Callable[[], Any]:
        return lambda: rg.transient(model, time="2 ms", discard="0 ms", method=method)

    runs: dict[str, Callable[[], Any]] = {
        "force laws": _evaluate_all_laws,
        "transient, exponential steps": briefly(pair, "exponential"),
        "transient, Newmark's steps": briefly(pair, "newmark"),
        "planets that go round, exponential steps": briefly(going_round, "exponential"),
        "planets that go round, Newmark's steps": briefly(going_round, "newmark"),
        "sweep": lambda: rg.sweep(pair, {speed: "2600 rpm"}, discard=2, sample=10),
        "orbits": lambda: rg.orbits(pair, {speed: "3900 rpm:4100 rpm"}, step=0.2),
    }
    begun = cpu_seconds()
    # Each step is told by its name; that it compiles is what was asked for.
    with progress_bar("compile", lines=True) as progress, hearing_forecasts(lambda *_: None):
        for number, (name, run) in enumerate(runs.items()):
            progress(number / len(runs), name)
            run()
    say(f"all machine code is ready, after {cpu_seconds() - begun:.0f} CPU s")


def _evaluate_all_laws() -> None:
    """Each law once, at speed, as an equilibrium asks for it."""
    from rotorgear.forces import registry

    for name in registry.names():
        registry.law_of(name).examples()[0].linearised(speed=100.0)


def validate(call: Call) -> None:
    """The validation cases, from a checkout of the repository."""
    root = Path.cwd()
    if not (root / "validation" / "runner.py").is_file():
        raise AnalysisError(
            "the validation cases are not part of the installed package: they lie in the folder validation/ of the repository "
            "and of the source archive (pip download rotorgear --no-deps --no-binary rotorgear); run this in the folder above it"
        )
    if str(root) not in sys.path:
        sys.path.insert(0, str(root))
    importlib.invalidate_caches()
    from validation.runner import main  # it stands outside the package

    raise typer.Exit(main(call["cases"] or [], call["json"]))
