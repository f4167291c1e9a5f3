"""Holes that were found by trying to break the program: what broke, what happens now, and the tests that hold it shut.

`python -m tests.extreme` runs those tests and prints the table. Right: the numbers agree with a reference. Refused: a sentence
says why and what to do. Flagged: the answer carries a warning.
"""

from __future__ import annotations

from dataclasses import dataclass

HOSTILE = "tests/extreme/test_hostile.py"
FRESH = "tests/contract/test_fresh_code.py"
STREAM = "tests/unit/export/test_stream.py"
CLUSTER = "tests/unit/analysis/sweep/test_cluster.py"
RELEASE = "tests/unit/test_release.py"


@dataclass(frozen=True)
class Hole:
    """One way in which the program was broken.

    Attributes:
        what: was done to it.
        outcome: what it does now: right, refused or flagged.
        file, tests: the tests that hold it, which stand in one file.
    """

    what: str
    outcome: str
    file: str
    tests: tuple[str, ...]


HOLES = (
    Hole(
        "a source is changed whose compiled code is kept",
        "right",
        FRESH,
        (
            "test_compiled_code_is_kept_in_a_folder_that_any_change_of_its_sources_renames",
            "test_a_change_of_an_inlined_function_reaches_the_compiled_loop",
            "test_compiled_loops_follow_a_change_of_the_contact_formula_and_agree_with_python",
            "test_the_sources_of_compiled_code_hold_what_is_compiled_into_it",
        ),
    ),
    Hole(
        "the elements of teeth are changed whose compliances are kept",
        "right",
        FRESH,
        ("test_a_change_of_the_elements_reaches_the_stored_compliances",),
    ),
    Hole(
        "a chunk of a run to go on with is missing, damaged or holds NaN",
        "refused",
        HOSTILE,
        ("test_chunks_that_do_not_fit_together_are_not_gone_on_with",),
    ),
    Hole(
        "a run is to go on under another version or with changed sources",
        "refused",
        STREAM,
        ("test_a_run_is_not_continued_by_another_program", "test_another_run_is_not_continued"),
    ),
    Hole(
        "a process is killed, and its run goes on", "right", STREAM, ("test_what_kill_leaves_is_readable_and_goes_on",)
    ),
    Hole(
        "a saved result holds NaN, too few values, or says that it holds 1e12",
        "refused",
        HOSTILE,
        ("test_a_result_that_was_changed_after_it_was_saved_is_refused",),
    ),
    Hole(
        "a list of rig lines has an open quote",
        "refused",
        HOSTILE,
        ("test_a_quote_that_is_not_closed_is_refused_in_its_line",),
    ),
    Hole(
        "a list of rig lines has decimal commas",
        "right",
        HOSTILE,
        ("test_a_decimal_comma_is_read_beside_semicolons_and_tabs",),
    ),
    Hole(
        "a list of rig lines has two decimal signs",
        "refused",
        HOSTILE,
        ("test_two_decimal_signs_in_one_list_are_refused_since_one_may_part_thousands",),
    ),
    Hole("a list of 1030 rig lines", "right", HOSTILE, ("test_a_thousand_rig_lines_are_compared",)),
    Hole(
        "gears stand in one another or hang over the end of their shaft",
        "flagged",
        HOSTILE,
        ("test_gears_in_one_another_or_beyond_their_shaft_are_told",),
    ),
    Hole(
        "the library of units does not work",
        "refused",
        HOSTILE,
        ("test_a_library_of_units_that_does_not_work_is_no_fault_of_the_user",),
    ),
    Hole(
        "dependencies of the oldest versions",
        "right",
        RELEASE,
        ("test_every_dependency_states_an_oldest_version_that_can_be_installed",),
    ),
    Hole(
        "springs hold something without inertia",
        "right",
        HOSTILE,
        ("test_springs_without_inertia_have_no_modes_and_are_left_out_by_name",),
    ),
    Hole(
        "dampers act on something without inertia",
        "refused",
        HOSTILE,
        ("test_dampers_without_inertia_are_refused_by_name",),
    ),
    Hole("a shaft of 1e3 to 1e6 m", "right", HOSTILE, ("test_a_shaft_as_long_as_a_country_is_right",)),
    Hole("parts of thirty decades", "refused", HOSTILE, ("test_parts_of_thirty_decades_are_refused_by_name",)),
    Hole(
        "a picture with an unknown ending",
        "refused",
        HOSTILE,
        ("test_a_picture_of_no_kind_is_refused_before_the_model_is_read",),
    ),
    Hole(
        "a name of 300 characters, a loop of links, a full device",
        "refused",
        HOSTILE,
        ("test_places_that_take_no_file_are_told_in_a_sentence", "test_an_output_that_takes_nothing_is_told"),
    ),
    Hole(
        "a disk fills while results are written",
        "refused",
        HOSTILE,
        ("test_a_full_disk_is_told_in_one_line_and_nothing_is_left",),
    ),
    Hole("an interrupt", "refused", HOSTILE, ("test_an_interrupt_is_told",)),
    Hole(
        "a flat disk is written with six digits",
        "right",
        HOSTILE,
        ("test_a_flat_disk_written_with_six_digits_is_taken",),
    ),
    Hole(
        "counts that are no whole numbers",
        "refused",
        HOSTILE,
        ("test_a_count_that_is_no_whole_number_is_refused",),
    ),
    Hole(
        "another machine looks for the workers of this one",
        "right",
        HOSTILE,
        ("test_workers_of_this_machine_listen_to_this_machine_only",),
    ),
    Hole(
        "workers over a network without certificates, or of another version",
        "refused",
        CLUSTER,
        (
            "test_tls_takes_the_certificates_of_dasks_settings_and_refuses_without",
            "test_workers_with_another_version_are_refused_at_the_door_and_later",
        ),
    ),
    Hole(
        "a check of thousands of shafts",
        "right",
        HOSTILE,
        ("test_a_check_costs_the_same_for_each_shaft_however_many_there_are",),
    ),
)
