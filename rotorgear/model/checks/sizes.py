"""Checks of numbers by themselves: materials, sections, and the 6 x 6 matrices of bearings, supports and couplings."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

from rotorgear.errors import Problem
from rotorgear.forces.clearance_classes import class_clearance
from rotorgear.forces.designations import inner_geometry
from rotorgear.model.parts.problems import shown
from rotorgear.model.parts.shaft import Section
from rotorgear.model.parts.supports import (
    Bearing,
    DampingMatrix,
    JournalGeometry,
    Oil,
    Pedestal,
    RollingElements,
    StiffnessMatrix,
    TableRow,
    ThrustGeometry,
)
from rotorgear.model.parts.tables import Tables
from rotorgear.quantity import RPM_PER_RAD_S, millimetres


def motions(model: Tables) -> Iterator[Problem]:
    """The model has at least one motion."""
    if not model.motions or len(set(model.motions)) < len(model.motions):
        yield Problem("motions", shown(list(model.motions)), "some of bending, axial, torsion, each once")


def materials(model: Tables) -> Iterator[Problem]:
    """A material has one of nu and G beside E, and nu is one of a stable material."""
    for name, material in model.materials.items():
        address = f"materials.{name}"
        given = (material.poisson_ratio is not None, material.shear_modulus is not None)
        if not any(given):
            yield Problem(address, "neither poisson_ratio nor shear_modulus", "one of them")
        elif all(given):
            hint = "the other follows from E = 2 G (1 + nu)"
            yield Problem(address, "poisson_ratio and shear_modulus", "one of them", hint)
        elif not -1.0 < material.nu < 0.5:
            hint = "it follows from nu = E/2G - 1" if material.shear_modulus else ""
            yield Problem(address, f"a Poisson's ratio of {material.nu:.4g}", "one between -1 and 0.5", hint)


def sections(model: Tables) -> Iterator[Problem]:
    """Every section has a wall, for the stiffness and for the mass."""
    for name, shaft in model.shafts.items():
        for number, section in enumerate(shaft.sections):
            yield from _section(f"shafts.{name}.sections[{number}]", section)


def _section(address: str, section: Section) -> Iterator[Problem]:
    outer, bore, outer_end, bore_end = section.stiffness_diameters()
    if bore >= outer:
        yield Problem(f"{address}.bore", millimetres(bore), f"less than the outer diameter there, {millimetres(outer)}")
        return
    if bore_end >= outer_end:
        limit = f"less than the outer diameter there, {millimetres(outer_end)}"
        hint = "" if section.bore_end is not None else "it keeps the bore of the left end: give bore_end"
        yield Problem(f"{address}.bore_end", millimetres(bore_end), limit, hint)
        return
    for key, base in (("mass_outer_diameter_end", "mass_outer_diameter"), ("mass_bore_end", "mass_bore")):
        if getattr(section, key) is not None and getattr(section, base) is None:
            yield Problem(f"{address}.{base}", "", "missing", f"required beside {key}")
            return
    outer, bore, outer_end, bore_end = section.mass_diameters()
    for inner, room in ((bore, outer), (bore_end, outer_end)):
        if inner > room:
            text = f"at most the outer diameter that counts for the mass there, {millimetres(room)}"
            yield Problem(f"{address}.mass_bore", millimetres(inner), text)
            return


def matrices(model: Tables) -> Iterator[Problem]:
    """Bearings, supports and couplings have what they need, each entry given once."""
    for name, bearing in model.bearings.items():
        yield from _bearing(f"bearings.{name}", bearing)
    for name, support in model.supports.items():
        yield from six_by_six(f"supports.{name}", support.stiffness, support.damping)
        if not (support.stiffness or support.damping or support.fixed):
            yield Problem(f"supports.{name}", "neither stiffness, damping nor fixed", "at least one of them")
    for name, element in model.nonlinear_elements.items():
        address = f"nonlinear_elements.{name}"
        if element.stiffness is not None and element.table:
            yield Problem(address, "stiffness and table", "one of the two")
        if element.damping is not None and element.stiffness is None:
            wanted = "a stiffness beside it, or neither: then the law's own tangents serve"
            yield Problem(f"{address}.damping", "damping without stiffness", wanted)
        yield from six_by_six(address, element.stiffness, element.damping)
        yield from _table(address, element.table)
    for name, coupling in model.couplings.items():
        yield from six_by_six(f"couplings.{name}", coupling.stiffness, coupling.damping)


def _bearing(address: str, bearing: Bearing) -> Iterator[Problem]:
    if bearing.stiffness is None and not bearing.table and not bearing.has_law:
        text = "stiffness (with damping), a table over speed, rolling elements, a journal, or a thrust bearing"
        yield Problem(address, "neither stiffness nor table", text)
    elif bearing.stiffness is not None and bearing.table:
        yield Problem(address, "stiffness and table", "one of the two")
    if bearing.table and bearing.damping is not None:
        yield Problem(f"{address}.damping", "damping beside a table", "damping in the rows of the table")
    yield from six_by_six(address, bearing.stiffness, bearing.damping)
    yield from _table(address, bearing.table)
    if bearing.rolling:
        yield from _rolling(address, bearing, bearing.rolling)
    if bearing.journal:
        yield from _journal(address, bearing, bearing.journal)
    if bearing.thrust:
        yield from _thrust(address, bearing, bearing.thrust)
    if bearing.pedestal:
        yield from _pedestal(f"{address}.pedestal", bearing.pedestal)


def _oil(here: str, film: Oil) -> Iterator[Problem]:
    """A viscosity, or a grade with the temperature at which the oil flows in."""
    if film.viscosity is not None and film.oil is not None:
        yield Problem(f"{here}.viscosity", "viscosity and oil", "one of the two")
    elif film.viscosity == 0.0:
        yield Problem(f"{here}.viscosity", "0", "a viscosity above 0 such as '0.02 Pa s'")
    elif film.viscosity is None and film.oil is None:
        yield Problem(here, "neither viscosity nor oil", "a viscosity such as '0.02 Pa s', or an oil such as 'VG 46'")
    if film.oil is not None and film.inlet_temperature is None:
        yield Problem(f"{here}.inlet_temperature", "no temperature beside the oil", "a temperature such as '45 degC'")
    if film.oil is None and (film.inlet_temperature is not None or film.heat_share != 1.0):
        key = "inlet_temperature" if film.inlet_temperature is not None else "heat_share"
        yield Problem(
            f"{here}.{key}", "heat of a film of given viscosity", "an oil such as 'VG 46' in place of the viscosity"
        )
    if film.heat_share > 1.0:
        yield Problem(f"{here}.heat_share", f"{film.heat_share:g}", "a share from 0 to 1")


def _journal(address: str, bearing: Bearing, journal: JournalGeometry) -> Iterator[Problem]:
    """An oil film alone in its bearing, with lobes that fit, on a grid that serves."""
    here = f"{address}.journal"
    beside = [key for key in ("stiffness", "damping", "rolling") if getattr(bearing, key) is not None]
    if beside or bearing.table:
        wanted = "a journal alone; what holds the shaft along z is a support or a bearing of its own"
        yield Problem(here, f"a journal beside {beside[0] if beside else 'a table'}", wanted)
    yield from _oil(here, journal)
    if journal.length > 2.0 * journal.diameter:
        got = f"{millimetres(journal.length)} on a diameter of {millimetres(journal.diameter)}"
        yield Problem(f"{here}.length", got, "at most two diameters, beyond which shafts bend in their bearing")
    if journal.clearance > 0.1 * journal.diameter:
        got = f"{millimetres(journal.clearance)} on a diameter of {millimetres(journal.diameter)}"
        yield Problem(f"{here}.clearance", got, "a film that is thin: at most a tenth of the diameter, 1e-3 as a rule")
    for key, most in (("lobes", 8), ("around", 2000), ("along", 200)):
        if getattr(journal, key) > most:
            yield Problem(f"{here}.{key}", f"{getattr(journal, key)}", f"at most {most}")
    for key, least in (("around", 24), ("along", 2)):
        if getattr(journal, key) < least:
            yield Problem(f"{here}.{key}", f"{getattr(journal, key)}", f"at least {least} cells")
    yield from _pads(here, journal)
    if journal.lobes == 1 and (
        (journal.preload and not journal.pads)
        or journal.lobe_arc is not None
        or journal.lobe_at
        or journal.offset != 0.5
    ):
        yield Problem(f"{here}.lobes", "keys of lobes in a plain bearing", "2 lobes or more beside them")
    if journal.lobes > 1 and journal.inlet is not None:
        yield Problem(f"{here}.inlet", "an inlet", "none beside lobes: oil comes in between them")
    if not 0.0 <= journal.preload < 1.0:
        yield Problem(f"{here}.preload", f"{journal.preload:g}", "a share from 0 to below 1")
    if journal.offset > 1.0:
        yield Problem(f"{here}.offset", f"{journal.offset:g}", "a share of the arc from 0 to 1")
    arc = 0.0 if journal.lobe_arc is None else journal.lobe_arc
    if not 0.0 <= journal.lobes * arc <= 2.0 * math.pi * (1.0 + 1e-9) or (journal.lobe_arc is not None and not arc):
        got = f"{journal.lobes} of {math.degrees(arc):.6g} deg"
        yield Problem(f"{here}.lobe_arc", got, "lobes that fit on 360 deg")


def _thrust(address: str, bearing: Bearing, thrust: ThrustGeometry) -> Iterator[Problem]:
    """Films along the shaft alone in their bearing, with pads that fit and carry."""
    here = f"{address}.thrust"
    beside = [key for key in ("stiffness", "damping", "rolling", "journal") if getattr(bearing, key) is not None]
    if beside or bearing.table:
        wanted = "a thrust bearing alone; what holds the shaft across is a bearing of its own, at the same place"
        yield Problem(here, f"a thrust bearing beside {beside[0] if beside else 'a table'}", wanted)
    yield from _oil(here, thrust)
    if thrust.inner_diameter >= thrust.outer_diameter:
        wanted = f"less than the outer diameter of {millimetres(thrust.outer_diameter)}"
        yield Problem(f"{here}.inner_diameter", millimetres(thrust.inner_diameter), wanted)
    if thrust.clearance > 0.05 * thrust.outer_diameter:
        wanted = "a film that is thin: at most a twentieth of the outer diameter, 1e-3 as a rule"
        yield Problem(f"{here}.clearance", millimetres(thrust.clearance), wanted)
    if not 1 <= thrust.pads <= 40:
        yield Problem(f"{here}.pads", str(thrust.pads), "1 to 40 pads")
    elif thrust.pad_arc is not None and not 0.0 < thrust.pads * thrust.pad_arc <= 2.0 * math.pi * (1.0 + 1e-9):
        got = f"{thrust.pads} of {math.degrees(thrust.pad_arc):.6g} deg"
        yield Problem(f"{here}.pad_arc", got, "pads that fit on 360 deg")
    if (thrust.taper is None) == (thrust.pivot is None):
        got = "neither taper nor pivot" if thrust.taper is None else "taper and pivot"
        yield Problem(here, got, "a taper of fixed pads, or the pivot of tilting ones")
    if thrust.pivot is not None and not 0.0 < thrust.pivot < 1.0:
        yield Problem(f"{here}.pivot", f"{thrust.pivot:g}", "a share of the arc between 0 and 1")
    if not 0.0 < thrust.taper_share <= 1.0:
        yield Problem(f"{here}.taper_share", f"{thrust.taper_share:g}", "a share of the arc above 0, up to 1")
    if not thrust.whirl_ratio:
        yield Problem(f"{here}.whirl_ratio", "0", "a ratio above 0; 1 is synchronous")
    for key, least, most in (("around", 6, 400), ("across", 4, 200)):
        if not least <= getattr(thrust, key) <= most:
            yield Problem(f"{here}.{key}", f"{getattr(thrust, key)}", f"{least} to {most} cells")


def _pads(here: str, journal: JournalGeometry) -> Iterator[Problem]:
    """Tilting pads that fit, with their keys beside them and none of fixed bearings."""
    if not journal.pads:
        if journal.pads == 0:
            yield Problem(f"{here}.pads", "0", "2 pads or more, or none of this key in a fixed bearing")
        elif journal.pad_arc is not None or journal.pad_at or journal.pivot != 0.5 or journal.whirl_ratio != 1.0:
            yield Problem(f"{here}.pads", "keys of pads in a fixed bearing", "the number of pads beside them")
        return
    if not 2 <= journal.pads <= 12:
        yield Problem(f"{here}.pads", str(journal.pads), "2 to 12 pads")
    if journal.lobes > 1 or journal.inlet is not None:
        yield Problem(f"{here}.pads", "pads beside lobes or an inlet", "one of them: oil comes in between pads")
    if journal.pad_arc is not None and not 0.0 < journal.pads * journal.pad_arc <= 2.0 * math.pi * (1.0 + 1e-9):
        got = f"{journal.pads} of {math.degrees(journal.pad_arc):.6g} deg"
        yield Problem(f"{here}.pad_arc", got, "pads that fit on 360 deg")
    if not 0.0 < journal.pivot < 1.0:
        yield Problem(f"{here}.pivot", f"{journal.pivot:g}", "a share of the arc between 0 and 1")
    if not journal.whirl_ratio:
        yield Problem(f"{here}.whirl_ratio", "0", "a ratio above 0; 1 is synchronous")


def _table(address: str, table: tuple[TableRow, ...]) -> Iterator[Problem]:
    speeds = [row.speed for row in table]
    if len(speeds) == 1 or any(b <= a for a, b in pairwise(speeds)) or any(s < 0 for s in speeds):
        rpm = ", ".join(f"{speed * RPM_PER_RAD_S:.6g}" for speed in speeds)
        wanted = "at least two rows with speeds that rise from 0 or more"
        yield Problem(f"{address}.table", f"speeds of {rpm} rpm", wanted)
    for number, row in enumerate(table):
        yield from six_by_six(f"{address}.table[{number}]", row.stiffness, row.damping)


def _rolling(address: str, bearing: Bearing, rolling: RollingElements) -> Iterator[Problem]:
    """Rolling elements that fit into their bearing, beside a stiffness that the linear analyses take."""
    here = f"{address}.rolling"
    if bearing.table or (bearing.stiffness and bearing.stiffness.given & {"matrix", "xy", "yx"}):
        wanted = "stiffness along x, y, axial and tilt beside them"
        yield Problem(here, "rolling elements beside a table or cross terms", wanted)
    if rolling.elements < 3:
        yield Problem(f"{here}.elements", str(rolling.elements), "at least 3")
    if rolling.elements * rolling.element_diameter > math.pi * rolling.pitch_diameter:
        text = f"{rolling.elements} of {millimetres(rolling.element_diameter)}"
        wanted = f"elements that fit on a circle of {millimetres(rolling.pitch_diameter)}"
        yield Problem(f"{here}.element_diameter", text, wanted)
    rollers = rolling.kind in ("roller", "tapered")
    known = inner_geometry(rolling.designation) if rolling.designation is not None else None
    for key, value in known.keys.items() if known is not None else ():
        given = getattr(rolling, key)
        if key != "contact_angle" and given != value and not (isinstance(given, float) and math.isclose(given, value)):
            wanted = f"{value if key == 'kind' else f'{value:.6g}'} as {rolling.designation} has it, or no designation"
            yield Problem(f"{here}.{key}", f"{given} beside designation = '{rolling.designation}'", wanted)
    if rollers != (rolling.length is not None):
        got = "a roller without length" if rollers else "a length of balls"
        yield Problem(f"{here}.length", got, "a length for rollers, none for balls")
    if rolling.kind == "roller" and rolling.contact_angle:
        yield Problem(f"{here}.contact_angle", "an angle", "0 for cylindrical rollers")
    yield from _rows(here, rolling)
    yield from _fit(here, rolling)
    for key in ("inner_groove", "outer_groove"):
        if getattr(rolling, key) <= 0.5:
            wanted = "more than 0.5: a groove is wider than its ball"
            yield Problem(f"{here}.{key}", f"{getattr(rolling, key):g}", wanted)
    if not abs(rolling.contact_angle) < 1.4:
        angle = f"{math.degrees(rolling.contact_angle):.6g} deg"
        yield Problem(f"{here}.contact_angle", angle, "an angle below 80 deg")
    reach = 2.0 * (rolling.inner_groove + rolling.outer_groove - 1.0) * rolling.element_diameter
    if not rollers and reach > 0.0 and rolling.clearance >= reach * math.cos(rolling.contact_angle):
        wanted = f"less than {millimetres(reach)}: the balls would fall out"
        yield Problem(f"{here}.clearance", millimetres(rolling.clearance), wanted)


def _rows(here: str, rolling: RollingElements) -> Iterator[Problem]:
    """Rows with the contact angle that makes them press, and slices of rollers."""
    if rolling.kind in ("tapered", "four-point") and not rolling.contact_angle:
        yield Problem(
            f"{here}.contact_angle", "0", f"an angle of a {rolling.kind} bearing, such as '15 deg' or '35 deg'"
        )
    pair = rolling.arrangement != "single"
    if pair and (rolling.kind not in ("ball", "tapered") or not rolling.contact_angle):
        wanted = "a pair of angular contact ball or tapered roller bearings, with their contact_angle"
        yield Problem(
            f"{here}.arrangement", f"{rolling.arrangement} of a {rolling.kind} bearing without an angle", wanted
        )
    if (pair or rolling.kind == "four-point") and rolling.contact_angle < 0.0:
        angle = f"{math.degrees(rolling.contact_angle):.6g} deg"
        yield Problem(f"{here}.contact_angle", angle, "a positive angle: the arrangement has the sides")
    if pair != (rolling.row_distance is not None):
        got = "a pair without a distance" if pair else "a distance of one row"
        yield Problem(f"{here}.row_distance", got, "the distance of the two rows beside an arrangement O, X or tandem")
    if rolling.slices is not None and not (rolling.kind in ("roller", "tapered") and 1 <= rolling.slices <= 200):
        yield Problem(f"{here}.slices", f"{rolling.slices} of a {rolling.kind} bearing", "1 to 200 slices of a roller")


def _fit(here: str, rolling: RollingElements) -> Iterator[Problem]:
    """A clearance class with its bore, and a preload of a bearing that can take one."""
    if rolling.clearance_class is not None:
        if rolling.kind != "ball" or rolling.contact_angle or rolling.clearance:
            wanted = "the class of a deep groove ball bearing alone, or a clearance"
            yield Problem(f"{here}.clearance_class", rolling.clearance_class, wanted)
        if rolling.bore is None or class_clearance(rolling.bore, rolling.clearance_class) is None:
            got = "no bore" if rolling.bore is None else millimetres(rolling.bore)
            yield Problem(f"{here}.bore", got, "a bore above 10 to 120 mm, which the table of classes has")
    elif rolling.bore is not None:
        yield Problem(f"{here}.bore", millimetres(rolling.bore), "a clearance_class beside it, which it is for")
    if (rolling.preload_displacement or rolling.preload_force) and not rolling.contact_angle:
        yield Problem(here, "a preload without a contact angle", "a contact_angle, along which it presses")
    if rolling.preload_displacement and rolling.preload_force:
        yield Problem(here, "preload_displacement and preload_force", "one of the two")


def _pedestal(address: str, pedestal: Pedestal) -> Iterator[Problem]:
    yield from six_by_six(address, pedestal.stiffness, pedestal.damping)
    if not pedestal.stiffness.given:
        return
    for key, matrix in (("stiffness", pedestal.stiffness), ("damping", pedestal.damping)):
        rows = matrix.as_rows() if matrix else ()
        if any(value for i, row in enumerate(rows) for j, value in enumerate(row) if max(i, j) > 2):
            yield Problem(f"{address}.{key}", "tilt or torsion", "x, y and axial only", "a pedestal is rigid in tilt")
    rows = pedestal.stiffness.as_rows()
    if not any(rows[i][i] for i in range(3)):
        hint = "leave the pedestal out if it is rigid"
        yield Problem(f"{address}.stiffness", "none along x, y or z", "a stiffness in one of them", hint)


def six_by_six(address: str, stiffness: StiffnessMatrix | None, damping: DampingMatrix | None) -> Iterator[Problem]:
    """A stiffness and a damping have entries, each given once, that are no springs of negative stiffness."""
    for key, matrix in (("stiffness", stiffness), ("damping", damping)):
        if matrix is None:
            continue
        given = matrix.given
        clashes = [("radial", {"x", "y"}), ("tilt", {"tilt_x", "tilt_y"}), ("matrix", given - {"matrix"})]
        for whole, parts in clashes:
            if whole in given and parts & given:
                names = ", ".join(sorted(parts & given))
                yield Problem(f"{address}.{key}", f"{whole} together with {names}", "one of the two ways to give it")
        if not given:
            yield Problem(f"{address}.{key}", "an empty table", "entries such as radial, axial or tilt, or a matrix")
        for i in range(6):
            if matrix.matrix is not None and matrix.matrix[i][i] < 0.0:
                place = f"{matrix.matrix[i][i]:g} in row {i + 1}, column {i + 1}"
                yield Problem(f"{address}.{key}.matrix", place, "0 or more on the diagonal")
