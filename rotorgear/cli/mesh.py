"""rotorgear mesh: stiffness, transmission error and load distribution of one mesh over its cycle."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rotorgear.cli.common import JsonOption, ModelFile, picture_name, vtk_folder, words_of
from rotorgear.cli.mesh_tasks import MeshCase, show_best_flanks, show_cycle, show_map, show_root_stress, write_teeth
from rotorgear.cli.mesh_texts import pairs_of, parse_factors, parse_over
from rotorgear.errors import AnalysisError


def mesh(
    model: ModelFile,
    mesh: Annotated[
        str | None, typer.Option("--mesh", help="Name of the mesh; not needed where there is one.", show_default=False)
    ] = None,
    stiffness: Annotated[
        str | None,
        typer.Option(
            "--stiffness",
            help="tooth_fe, iso, contact_line, potential_energy, or given (the numbers of the file). "
            "Default: the model that the file names, else tooth_fe.",
            show_default=False,
        ),
    ] = None,
    torque: Annotated[
        str | None,
        typer.Option(
            "--torque", help="Torque on the pinion, such as '2000 N m', in place of the model's.", show_default=False
        ),
    ] = None,
    preset: Annotated[
        str | None,
        typer.Option("--preset", help="preview, default or fine, in place of the file's.", show_default=False),
    ] = None,
    accuracy: Annotated[
        float | None,
        typer.Option(
            "--accuracy", help="Take the cheapest preset whose estimated error is within this.", show_default=False
        ),
    ] = None,
    body: Annotated[
        str | None, typer.Option("--body", help="Body under the teeth: rim, ring or wheel.", show_default=False)
    ] = None,
    positions: Annotated[
        int | None,
        typer.Option(
            "--positions", help="Positions in one mesh period; default 64, 24 for --root-stress.", show_default=False
        ),
    ] = None,
    periods: Annotated[
        int | None,
        typer.Option(
            "--periods", help="Mesh periods; default 1, or until all pitch errors have passed.", show_default=False
        ),
    ] = None,
    load_factors: Annotated[
        str | None,
        typer.Option(
            "--load-factors", help="Also solve at these multiples of the load: '0.1,0.5,2'.", show_default=False
        ),
    ] = None,
    over: Annotated[
        list[str] | None,
        typer.Option(
            "--over",
            help="Map over 'torque=500 N m:2000 N m:4' and 'misalignment=-20 um:20 um:5' (first, last, how many; or a list with "
            "colons); may be given twice, or both with a comma.",
            show_default=False,
        ),
    ] = None,
    csv: Annotated[
        Path | None, typer.Option("--csv", help="Write the points of --over to this table.", show_default=False)
    ] = None,
    optimise: Annotated[
        str | None,
        typer.Option(
            "--optimise",
            help="Find these flank modifications for the smallest mean peak to peak of the transmission error over --over: "
            "'tip_relief,tip_relief_length,wheel.crowning'.",
            show_default=False,
        ),
    ] = None,
    bounds: Annotated[
        list[str] | None,
        typer.Option("--bounds", help="Bounds of one of them: 'tip_relief=0 um:60 um'.", show_default=False),
    ] = None,
    tolerance: Annotated[
        list[str] | None,
        typer.Option(
            "--tolerance",
            help="Tolerance of one of them, up and down: 'tip_relief=5 um'. Default: a tenth of its bounds.",
            show_default=False,
        ),
    ] = None,
    weights: Annotated[
        str | None, typer.Option("--weights", help="Weights of the torques of --over: '1,2,1'.", show_default=False)
    ] = None,
    pressure_limit: Annotated[
        str | None,
        typer.Option(
            "--pressure-limit", help="Largest contact pressure of --optimise: '1200 MPa'.", show_default=False
        ),
    ] = None,
    evaluations: Annotated[
        int | None,
        typer.Option("--evaluations", help="Flanks that --optimise tries; default 60 for each.", show_default=False),
    ] = None,
    samples: Annotated[
        int | None,
        typer.Option("--samples", help="Flanks of the tolerance band of --optimise; 0 for none.", show_default=False),
    ] = None,
    root_stress: Annotated[
        bool,
        typer.Option("--root-stress", help="Follow the stress in the tooth roots of both gears over the mesh cycle."),
    ] = False,
    harmonics: Annotated[int, typer.Option("--harmonics", min=0, help="Mesh orders that are listed.")] = 5,
    plot: Annotated[
        Path | None,
        typer.Option(
            "--plot",
            help="Draw the curves and the contact to this PNG or SVG.",
            show_default=False,
            callback=picture_name,
        ),
    ] = None,
    vtk: Annotated[
        Path | None,
        typer.Option(
            "--vtk",
            help="Write both tooth meshes with deflection, stress and pressure into this folder.",
            show_default=False,
            callback=vtk_folder,
        ),
    ] = None,
    at: Annotated[float, typer.Option("--at", help="Position in mesh periods that --vtk writes.")] = 0.0,
    json: JsonOption = None,
) -> None:
    """Print stiffness, transmission error, load sharing and pressure of one mesh over its cycle."""
    import rotorgear as rg

    case = MeshCase(rg.load(model), mesh, torque, preset, body, positions)
    only_of_a_cycle = {
        "stiffness": stiffness,
        "accuracy": accuracy,
        "periods": periods,
        "load_factors": load_factors,
        "vtk": vtk,
    }
    if root_stress:
        refuse_beside("--root-stress", **only_of_a_cycle, over=over, optimise=optimise, csv=csv)
        show_root_stress(case, plot, json)
        return
    if optimise is not None:
        refuse_beside("--optimise", **only_of_a_cycle, csv=csv, plot=plot)
        show_best_flanks(
            case,
            words_of(optimise),
            over=parse_over(over or []),
            bounds={name: text.split(":") for name, text in pairs_of("--bounds", bounds).items()},
            tolerance=pairs_of("--tolerance", tolerance),
            weights=None if weights is None else parse_factors(weights, "--weights"),
            pressure_limit=pressure_limit,
            samples=64 if samples is None else samples,
            evaluations=evaluations,
            json=json,
        )
        return
    refuse_without(
        "--optimise",
        bounds=bounds,
        tolerance=tolerance,
        weights=weights,
        pressure_limit=pressure_limit,
        evaluations=evaluations,
        samples=samples,
    )
    if over:
        refuse_beside("--over", **only_of_a_cycle)
        show_map(case, parse_over(over), csv, plot, json)
        return
    if csv:
        raise AnalysisError("--csv writes the points of --over: give --over too.")
    result = show_cycle(
        case,
        stiffness=stiffness,
        accuracy=accuracy,
        periods=periods,
        load_factors=parse_factors(load_factors),
        harmonics=harmonics,
        plot=plot,
        json=json,
    )
    if vtk:
        write_teeth(case, result, vtk, at)


def refuse_beside(option: str, **given: object) -> None:
    """AnalysisError for options that an option does not go with."""
    for name, value in given.items():
        if value is not None:
            raise AnalysisError(f"--{name.replace('_', '-')} does not go with {option}.")


def refuse_without(option: str, **given: object) -> None:
    """AnalysisError for options that say nothing without another one."""
    for name, value in given.items():
        if value is not None:
            raise AnalysisError(f"--{name.replace('_', '-')} belongs to {option}: give that too.")
