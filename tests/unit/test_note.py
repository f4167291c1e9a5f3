"""Facts that are their own sentences, and one sentence for each cause."""

from __future__ import annotations

import pickle

from rotorgear.note import NAMED, Note, as_notes, sentences

CAUSE = ("the backlash", "teeth in contact do not reach it")


def test_a_fact_is_its_own_sentence() -> None:
    note = Note("meshes.pair", *CAUSE, "0.1 mm")
    assert note == "meshes.pair (0.1 mm): the backlash; teeth in contact do not reach it"
    assert "backlash" in note
    assert Note("meshes.pair.backlash", "", "no reason") == "meshes.pair.backlash: no reason"
    assert Note("", "gyroscopic matrix", "standstill") == "gyroscopic matrix: standstill"
    again = pickle.loads(pickle.dumps(note))
    assert (again.part, again.what, again.why, again.value) == ("meshes.pair", *CAUSE, "0.1 mm")


def test_parts_of_one_cause_share_a_sentence() -> None:
    notes = [Note(f"meshes.{name}", *CAUSE, size) for name, size in (("a", "1 um"), ("b", "1 um"), ("c", "2 um"))]
    other = Note("", "weight", "no gravity is given")
    said = sentences([notes[0], other, *notes[1:]])
    assert said == [
        "meshes.a, meshes.b (1 um) and meshes.c (2 um): the backlash; teeth in contact do not reach it",
        "weight: no gravity is given",
    ]


def test_a_screen_names_few_of_many_parts_and_a_file_all() -> None:
    notes = [Note(f"bearings.b{k}", "worn") for k in range(NAMED + 2)]
    assert sentences(notes, NAMED) == [f"bearings.b0 and {NAMED + 1} more: worn"]
    (whole,) = sentences(notes)
    assert all(note.part in whole for note in notes)


def test_plain_sentences_are_facts_about_no_part_and_each_fact_stands_once() -> None:
    found = as_notes(["one", Note("a", "b"), "one"])
    assert found == ("one", "a: b")
    assert found[0].what == "one"
