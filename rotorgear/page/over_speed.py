"""Sections of the page on the machine over its speed: Campbell diagram, critical speeds, rules of standards, run-up."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.page.cells import RESULTS, Cell, Figure, Numbers, Section, Table, words
from rotorgear.page.curves import draw_unbalance
from rotorgear.page.figures import svg_of
from rotorgear.plots.campbell import campbell as draw_campbell
from rotorgear.plots.critical_map import critical_map as draw_map
from rotorgear.plots.response import response as draw_response

_LARGEST = 12


def campbell_section(made: dict[str, Any], numbers: Numbers) -> Section:
    """The diagram, margins at the operating speed, and onsets of instability."""
    result = made["campbell"]
    section = Section("campbell", "Campbell diagram and margins")
    section.figures.append(
        Figure(
            "Natural frequencies over speed, and lines of excitation.",
            svg_of(draw_campbell(result), "Campbell diagram"),
        )
    )
    top = (RESULTS, "campbell", "margins")
    rows = [
        [
            numbers.word(*top, k, "line"),
            numbers.cell(".2f", *top, k, "frequency_hz"),
            numbers.cell(".2f", *top, k, "mode_hz"),
            numbers.cell("+.2f", *top, k, "margin", factor=100.0),
            numbers.word(*top, k, "whirl"),
            numbers.cell(".1f", *top, k, "crossing_speed_rpm"),
        ]
        for k in range(len(result.margins))
    ]
    heads = ("line at the operating speed", "Hz", "nearest mode, Hz", "margin, %", "whirl", "meets at, rpm")
    section.tables.append(Table("Margins of modes that the line can excite", heads, rows))
    if result.onsets:
        rows = [
            [
                numbers.cell("d", RESULTS, "campbell", "onsets", k, "branch"),
                numbers.cell(".1f", RESULTS, "campbell", "onsets", k, "speed_rpm"),
                numbers.cell(".3f", RESULTS, "campbell", "onsets", k, "frequency_hz"),
            ]
            for k in range(len(result.onsets))
        ]
        section.tables.append(Table("Onset of instability", ("branch", "from, rpm", "Hz"), rows))
    else:
        section.words.append("Stability: no branch grows in this range of speeds.")
    return section


def critical_section(made: dict[str, Any], numbers: Numbers) -> Section:
    """Speeds at which 1x of a shaft meets a mode, and the map over the stiffness of the bearings."""
    result = made["critical"]
    section = Section("critical", "Critical speeds")
    if "critical_map" in made and np.isfinite(made["critical_map"].critical_speeds).any():
        caption = (
            "Undamped critical speeds over one stiffness of all bearings; vertical lines: the bearings of the model."
        )
        section.figures.append(Figure(caption, svg_of(draw_map(made["critical_map"]), "Critical speed map")))
    top = (RESULTS, "critical")
    rows = [
        [
            numbers.word(*top, "line", k),
            numbers.cell(".2f", *top, "critical_speed_rpm", k),
            numbers.cell(".3f", *top, "frequency_hz", k),
            numbers.cell(".4f", *top, "damping_ratio", k),
            numbers.word(*top, "whirl", k),
            Cell("yes" if result.speeds[k].excited else "no"),
            numbers.cell(".0e", *top, "error_estimate", k),
            numbers.word(*top, "description", k),
        ]
        for k in range(len(result))
    ]
    heads = ("line", "rpm of the input", "Hz", "damping ratio", "whirl", "excited", "error", "what moves")
    if rows:
        section.tables.append(Table("Speeds at which 1x of a shaft meets a mode", heads, rows))
    else:
        section.words.append("No line meets a mode in the range of speeds.")
    return section


def standards_section(made: dict[str, Any], numbers: Numbers) -> Section:
    """Peaks of the unbalance response, and verdicts of the rules."""
    result = made["standards"]
    section = Section("standards", "Unbalance response and rules of standards")
    section.words.append(
        "Each verdict speaks of the one rule beside it. None says that the machine meets a standard: that takes more than these."
    )
    if result.curves:
        caption = (
            "Response to the rules' unbalance in the shape of each shaft's first peak; dashed: the operating speed."
        )
        section.figures.append(Figure(caption, svg_of(draw_unbalance(result), "Unbalance response")))
    top = (RESULTS, "standards")
    rows = [
        [
            numbers.word(*top, "criticals", k, "shaft"),
            numbers.cell(".1f", *top, "criticals", k, "shaft_rpm"),
            numbers.cell(".1f", *top, "criticals", k, "below_rpm"),
            numbers.cell(".1f", *top, "criticals", k, "above_rpm"),
            numbers.cell(".5g", *top, "criticals", k, "amplification_factor"),
            numbers.cell(".2f", *top, "criticals", k, "margin_percent"),
            numbers.cell(".2f", *top, "criticals", k, "required_percent"),
            numbers.word(*top, "criticals", k, "description"),
        ]
        for k in range(len(result.criticals))
    ]
    if rows:
        heads = ("shaft", "peak, rpm", "N₁, rpm", "N₂, rpm", "AF", "separation, %", "asked for, %", "what moves")
        section.tables.append(Table("Peaks of the unbalance response, speeds of the shaft", heads, rows))
    rows = [
        [
            numbers.word(*top, "checks", k, "rule"),
            numbers.word(*top, "checks", k, "part"),
            numbers.cell(".4g", *top, "checks", k, "value"),
            numbers.cell(".4g", *top, "checks", k, "limit"),
            numbers.word(*top, "checks", k, "unit"),
            numbers.word(*top, "checks", k, "verdict"),
            numbers.word(*top, "checks", k, "note"),
        ]
        for k in range(len(result.checks))
    ]
    rule_heads = ("rule", "part", "value", "limit", "unit", "verdict", "about")
    section.tables.append(Table("Rules", rule_heads, rows, left=2, verdict=5))
    rows = [words(rule.name, rule.source, rule.formula) for rule in result.rules]
    section.tables.append(Table("What the rules say", ("rule", "standard", "formula"), rows, left=3))
    return section


def response_section(made: dict[str, Any], numbers: Numbers) -> Section:
    """Amplitudes over speed, and the largest of them."""
    result = made["response"]
    section = Section("run-up", "Run-up")
    section.words.append(
        "Linear response to the unbalances, transmission errors and stiffness variation that the model has."
    )
    if not result.damping_ratio and not np.any(result.model.damping.model_dump(exclude_defaults=True)):
        section.words.append(
            "No damping is given to the model as a whole: heights near resonances are those of the nearest speed."
        )
    section.figures.append(Figure("Amplitudes over speed.", svg_of(draw_response(result), "Run-up")))
    top = (RESULTS, "response", "largest")
    rows = [
        [
            numbers.word(*top, k, "quantity"),
            numbers.word(*top, k, "part"),
            Cell(result.orders[peak.order]),
            numbers.cell(".1f", *top, k, "speed_rpm"),
            numbers.cell(".2f", *top, k, "frequency_hz"),
            numbers.cell(".4g", *top, k, "amplitude"),
            numbers.word(*top, k, "unit"),
        ]
        for k, peak in enumerate(result.largest[:_LARGEST])
    ]
    heads = ("quantity", "part", "order", "rpm of the input", "Hz", "amplitude", "unit")
    section.tables.append(Table("Largest amplitudes at the speeds that were computed", heads, rows, left=3))
    return section
