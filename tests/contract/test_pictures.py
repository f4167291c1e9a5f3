"""Every picture from Python: one signature, on the caller's axes or its own, without pyplot, windows or files."""

from __future__ import annotations

import inspect
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from tests.models import pair_file, record_beside_a_pair
from tests.paths import ROOT
from tests.unit.analysis.static.test_bearing_states import BALLS
from tests.unit.analysis.static.test_bearing_states import rotor as pulled_rotor

pytest.importorskip("matplotlib")
MODELS = ROOT / "models"
# What is drawn of each result, the first by `result.plot()`.
PICTURES = {
    "campbell": ("campbell",),
    "critical_map": ("critical_map",),
    "static": ("static",),
    "response": ("response", "waterfall", "order_map"),
    "frf": ("frf",),
    "bearing": ("bearing",),
    "gear": ("gear",),
    "mesh": ("mesh", "mesh_pressure", "mesh_loads"),
    "mesh_map": ("mesh_map", "mesh_quantity"),
    "root_stress": ("root_stress",),
    "convergence": ("convergence",),
    "transient": ("transient", "mesh_forces", "transmission_error", "spectra", "shaft_orbits", "energy", "spectrogram"),
    "orbits": ("orbits",),
    "scatter": ("scatter",),
    "optimise": ("optimise",),
    "compare_shapes": ("compare_shapes",),
    "compare_time": ("compare_time",),
    "sweep": ("sweep", "bifurcation", "sections", "portraits", "portrait_spectra"),
}
# Of a stage of pyvista, of a map over two parameters, and of minutes of contact analyses: each has its own test or a long one.
ELSEWHERE = {"modal", "sweep_map", "mesh_convergence", "save"}


def shapes_of_a_jeffcott_rotor() -> rg.ShapeComparison:
    """Its own frequencies, with any shapes at two places."""
    modes = rg.modal(rg.load(MODELS / "jeffcott.toml"), modes=6, elements=2)
    elastic = modes.frequency_hz[~modes.rigid]
    lines = tuple(rg.RigLine(float(f)) for f in elastic)
    shapes = np.random.default_rng(1).standard_normal((len(lines), 2))
    return rg.compare_shapes(modes, rg.Measured(lines, ("disks.disk:x", "disks.disk:y"), shapes), samples=20)


@pytest.fixture(scope="module")
def results() -> dict[str, Any]:
    """A small result of every verb that has pictures."""
    jeffcott = rg.load(MODELS / "jeffcott.toml")
    pair = rg.load(MODELS / "helical_pair.toml")
    loose = rg.load(MODELS / "backlash_pair.toml")
    return {
        "campbell": rg.campbell(jeffcott, points=5, modes=4, elements=1),
        "critical_map": rg.critical_map(jeffcott, stiffness=[1e6, 1e7, 1e8], elements=1),
        "static": rg.static(pair, elements=1),
        "response": rg.response(
            rg.load(MODELS / "split_torque.toml"), points=3, fmax=3000.0, modal_damping=0.02, elements=1
        ),
        "frf": rg.frf(jeffcott, inputs=["disks.disk:x"], outputs=["disks.disk:x"], fmax=100.0, points=9, elements=1),
        "bearing": rg.bearing(pulled_rotor(BALLS, '["1 kN", "0 N", "0 N"]', "3000 rpm"), stability=False),
        "gear": rg.gear(pair),
        "mesh": rg.mesh(rg.loads(pair_file()), preset="preview", positions=8, load_factors=(0.5,)),
        "root_stress": rg.root_stress(rg.loads(pair_file()), preset="preview", positions=4),
        "mesh_map": rg.mesh_map(
            rg.loads(pair_file()),
            over={"torque": [500.0, 1000.0], "misalignment": [0.0, 1e-5]},
            preset="preview",
            positions=8,
        ),
        "convergence": rg.convergence_study(jeffcott, modes=4, elements=(1, 2), accuracies=(), repeat=1),
        "transient": rg.transient(
            rg.load(MODELS / "flexible_pair.toml"),
            speed="3000 rpm",
            speed_to="3300 rpm",
            time="4 ms",
            steps=40,
            error_estimate=False,
        ),
        "optimise": rg.optimise(jeffcott, "shafts.*.sections.*.outer_diameter", searches=1, elements=2),
        "compare_shapes": shapes_of_a_jeffcott_rotor(),
        "compare_time": record_beside_a_pair(),
        "scatter": rg.scatter(jeffcott, "bearings.*.stiffness", samples=8, modes=4, elements=1),
        "orbits": rg.orbits(loose, {"operation.speed": "4000 rpm:4200 rpm"}, step=0.5),
        "sweep": rg.sweep(
            loose, {"operation.speed": ["3000 rpm", "3250 rpm"]}, steps=80, discard=20, sample=20, portraits=2
        ),
    }


def test_every_picture_is_listed_here() -> None:
    assert {name for names in PICTURES.values() for name in names} | ELSEWHERE == set(rg.plot.__all__)


@pytest.mark.parametrize("name", sorted(set(rg.plot.__all__) - {"save"}))
def test_a_picture_takes_a_result_then_where_to_draw_then_options_by_name(name: str) -> None:
    parameters = list(inspect.signature(getattr(rg.plot, name)).parameters.values())
    assert parameters[0].name == "result"
    assert parameters[1].name in ("ax", "fig", "plotter")
    assert parameters[1].default is None
    assert all(parameter.kind is parameter.KEYWORD_ONLY for parameter in parameters[2:])


@pytest.mark.parametrize(("verb", "name"), [(verb, name) for verb, names in PICTURES.items() for name in names])
def test_a_picture_is_drawn_on_its_own_figure_and_on_the_callers(
    results: dict[str, Any], verb: str, name: str, tmp_path: Path
) -> None:
    from matplotlib.figure import Figure

    draw = getattr(rg.plot, name)
    axes = draw(results[verb])
    assert rg.plot.save(axes, tmp_path / f"{name}.png").stat().st_size > 3000
    for one in np.atleast_1d(np.asarray(axes, dtype=object)).flat:
        assert one.has_data()
    where = list(inspect.signature(draw).parameters)[1]
    figure = Figure(figsize=(20.0, 12.0), layout="constrained")
    if where == "ax":
        given = figure.subplots()
        assert draw(results[verb], given) is given
    else:
        part = figure.subfigures(1, 2)[0]
        drawn = np.asarray(draw(results[verb], part)).flat[0]
        assert drawn.figure in (part, *part.subfigs)
    figure.savefig(tmp_path / "callers.png", dpi=30)
    assert figure.get_suptitle() == "", "the title of a caller's figure is the caller's"


@pytest.mark.parametrize("verb", PICTURES)
def test_a_picture_says_along_its_axes_what_is_drawn(results: dict[str, Any], verb: str) -> None:
    for name in PICTURES[verb]:
        axes = np.atleast_1d(np.asarray(getattr(rg.plot, name)(results[verb]), dtype=object))
        figure = axes.flat[0].figure.figure
        # Along a shared axis the label stands once: at the last panel, or for the whole figure.
        assert any(one.get_xlabel() for one in axes.flat) or figure.get_supxlabel(), name
        for one in axes.flat:
            assert one.get_ylabel() or one.get_title() or figure.get_supylabel() or verb == "convergence", name


def test_pictures_leave_pyplot_alone(results: dict[str, Any]) -> None:
    before = "matplotlib.pyplot" in sys.modules
    rg.plot.campbell(results["campbell"])
    rg.plot.transient(results["transient"])
    if before:
        import matplotlib.pyplot as plt

        assert plt.get_fignums() == []
    else:
        assert "matplotlib.pyplot" not in sys.modules


@pytest.mark.parametrize("verb", PICTURES)
def test_a_result_draws_itself_with_the_picture_of_its_kind(
    results: dict[str, Any], verb: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    result = results[verb]
    assert result.kind == verb == PICTURES[verb][0]
    drawn: list[Any] = []
    monkeypatch.setitem(vars(rg.plot), verb, lambda *args, **options: drawn.append((*args, options)))
    result.plot("here", colour="red")
    assert drawn == [(result, "here", {"colour": "red"})]


def test_a_result_without_a_picture_says_so() -> None:
    with pytest.raises(rg.AnalysisError, match="'check' has no picture"):
        rg.check(rg.load(MODELS / "jeffcott.toml")).plot()


def test_what_a_result_has_no_data_for_is_refused_in_a_sentence(results: dict[str, Any]) -> None:
    with pytest.raises(rg.AnalysisError, match="over two parameters"):
        rg.plot.sweep_map(results["sweep"])
    with pytest.raises(rg.AnalysisError, match="PNG, SVG or PDF"):
        rg.plot.save(rg.plot.static(results["static"]), "static.jpg")
