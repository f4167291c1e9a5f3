"""What a model holds and the numbers of an analysis do not depend on is what the analysis says it left out, in both directions.

Each key is changed by a little, those that are said to be left out all at once, the analysis is run again, and its numbers are
compared: the notes decide what is changed together, not what counts as used.
"""

from __future__ import annotations

from typing import Any

import pytest

import rotorgear as rg
from rotorgear.note import Note, as_notes
from tests.unit.analysis.left_out.models_used import MODELS
from tests.unit.analysis.left_out.used import LONG_VERBS, VERBS, used

# Long: a motion of the whole gearbox, or maps of loaded teeth, for each of its keys.
SLOW = {
    ("split torque", "transient"),
    ("journal", "transient"),
    ("element with a stiffness", "response"),
    ("iso", "response"),
    ("tilting", "response"),
}
QUICK = {
    "campbell": ("full", "rotor"),
    "critical": ("full", "rotor"),
    "state space": ("full", "journal"),
    "sweep": ("plain", "backlash pair"),
    "orbits": ("plain",),
}
# Of models drawn at random these verbs are quick, and all verbs of the others long.
AT_RANDOM = ("modal", "modal at speed", "static", "frf")
DRAWN = ("random 0", "random 1", "random 2")


def cases() -> list[object]:
    """All pairs of models and analyses; the slow ones, and every other of the rest, as on a chequerboard, are long."""
    found = []
    for row, name in enumerate(MODELS):
        for column, verb in enumerate((*VERBS, *LONG_VERBS)):
            slow = verb in VERBS and not name.startswith("random") and (row + column) % 2 == 1
            slow |= (name, verb) in SLOW or name.startswith("loaded teeth") or name not in QUICK.get(verb, MODELS)
            slow |= name.startswith("random") and not (name in DRAWN and verb in AT_RANDOM)
            found.append(pytest.param(name, verb, marks=pytest.mark.long if slow else ()))
    return found


def covers(part: str, key: str) -> bool:
    """Whether a fact about an address is one about a key."""
    return key == part or key.startswith((f"{part}.", f"{part}["))


def facts_of(result: Any) -> list[Note]:
    """What a result says of parts of the model."""
    return [note for note in as_notes(result.left_out) if note.part]


def said_to_be_left_out(result: Any, key: str) -> bool:
    """Whether a fact denies all that a key does."""
    return any(covers(fact.part, key) and not fact.what for fact in facts_of(result))


@pytest.mark.parametrize(("name", "verb"), cases())
def test_what_is_not_used_is_left_out_and_what_is_left_out_is_not_used(name: str, verb: str) -> None:
    try:
        result, moves = used(MODELS[name](), verb, said_to_be_left_out)
    except rg.RotorgearError as error:
        pytest.skip(str(error))
    facts = facts_of(result)
    said = {key: [fact for fact in facts if covers(fact.part, key)] for key in moves}
    # A fact that names a part of what a key does, such as the damping of vibration, leaves the rest in use.
    denied = {key: [fact for fact in said[key] if not fact.what] for key, moved in moves.items() if moved}
    assert {key: found for key, found in denied.items() if found} == {}
    assert [key for key, moved in moves.items() if not moved and not said[key]] == []
    assert all(fact.why or fact.what for fact in facts)


def test_there_are_twenty_models() -> None:
    assert len(MODELS) >= 20
