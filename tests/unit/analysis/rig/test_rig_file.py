"""Rig files: what may stand in them, and what is said of those that are wrong."""

from __future__ import annotations

import pytest

from rotorgear.analysis.rig.rig_file import read_rig_lines
from rotorgear.errors import ModelError
from rotorgear.results.comparison import RigLine


@pytest.fixture
def read(tmp_path):
    def write_and_read(text, encoding="utf-8"):
        path = tmp_path / "rig.csv"
        path.write_bytes(text.encode(encoding))
        return read_rig_lines(path)

    return write_and_read


@pytest.fixture
def problems(read):
    def collect(text):
        with pytest.raises(ModelError) as caught:
            read(text)
        return {problem.address: str(problem) for problem in caught.value.problems}

    return collect


def test_a_bare_column_of_numbers_is_in_hertz(read):
    assert read("frequency_hz\n361\n834.5\n1.818e3\n") == (RigLine(361.0), RigLine(834.5), RigLine(1818.0))


def test_all_columns_with_units_in_the_cells(read):
    text = 'label,frequency,uncertainty,damping\n"A, left",361 Hz,2 %,1.2 %\nB,1.818 kHz,2 Hz,0.01\nC,6000 rpm,,\n'
    first, second, third = read(text)
    assert (first.label, first.frequency_hz, first.damping_ratio) == ("A, left", 361.0, pytest.approx(0.012))
    assert first.uncertainty_hz == pytest.approx(7.22)
    assert (second.frequency_hz, second.uncertainty_hz, second.damping_ratio) == (pytest.approx(1818.0), 2.0, 0.01)
    assert (third.frequency_hz, third.uncertainty_hz, third.damping_ratio) == (pytest.approx(100.0), None, None)


@pytest.mark.parametrize("header", ["frequency (kHz)", "Frequency [kHz]", "frequency_khz", "FREQUENCY kHz"])
def test_a_unit_in_the_header_holds_for_plain_numbers_and_a_unit_in_the_cell_wins(read, header):
    lines = read(f"{header},uncertainty [%],damping_percent\n0.361,2,1.5\n834 Hz,1 Hz,0.01 %\n")
    assert [line.frequency_hz for line in lines] == pytest.approx([361.0, 834.0])
    assert [line.uncertainty_hz for line in lines] == pytest.approx([7.22, 1.0])
    assert [line.damping_ratio for line in lines] == pytest.approx([0.015, 0.0001])


def test_comments_blank_lines_a_byte_order_mark_and_semicolons_are_understood(read):
    text = "\ufeff# shaker test\n\nfrequency_hz;label\n# first\n361;A, left\n;\n834;B\n"
    assert read(text) == (RigLine(361.0, "A, left"), RigLine(834.0, "B"))


def test_every_bad_row_is_reported_at_once_with_its_line_and_column(problems):
    found = problems(
        "# rig\nfrequency,uncertainty,damping\n-361,,\nnan,,\n834,lots,\n900,,7\n"
        ",2,\n10 mm,,\n50,60 Hz,-1\n0,,\n1000,,\n"
    )
    assert list(found) == [
        "rig.csv:3:frequency",
        "rig.csv:4:frequency",
        "rig.csv:5:uncertainty",
        "rig.csv:6:damping",
        "rig.csv:7:frequency",
        "rig.csv:8:frequency",
        "rig.csv:9:uncertainty",
        "rig.csv:9:damping",
        "rig.csv:10:frequency",
    ]
    assert found["rig.csv:3:frequency"] == (
        "rig.csv:3:frequency: got '-361', expected a positive frequency such as '361 Hz'"
    )
    assert "'10 mm'" in found["rig.csv:8:frequency"]
    assert "1.2 %" in found["rig.csv:6:damping"]


def test_a_frequency_given_twice_names_both_lines(problems):
    found = problems("frequency\n361\n834\n0.834 kHz\n")
    assert list(found) == ["rig.csv:4:frequency"]
    assert found["rig.csv:4:frequency"].endswith("got '0.834 kHz', expected every frequency once (it is in line 3)")


def test_a_missing_frequency_column_is_said_and_the_nearest_name_offered(problems):
    found = problems("frequncy_hz,label\n361,A\n")
    assert "did you mean 'frequency_hz'?" in found["rig.csv:1:frequncy_hz"]
    assert "a column 'frequency'" in found["rig.csv:1"]


def test_numbers_without_a_header_are_not_taken_for_one(problems):
    assert "a column 'frequency'" in problems("361\n834\n")["rig.csv:1"]


def test_an_unknown_column_is_no_silent_loss(problems):
    assert "did you mean 'uncertainty'?" in problems("frequency,uncertanty\n361,2\n")["rig.csv:1:uncertanty"]


def test_a_unit_that_a_column_cannot_have_is_refused(problems):
    assert list(problems("frequency_mm\n361\n")) == ["rig.csv:1:frequency_mm", "rig.csv:1"]


def test_two_columns_of_one_meaning_are_refused(problems):
    assert "2 columns for frequency" in problems("frequency,frequency_hz\n361,361\n")["rig.csv:1"]


def test_a_cell_without_a_column_is_reported_with_its_likely_cause(problems):
    assert "decimal comma" in problems("frequency,label\n361,5,A\n")["rig.csv:2"]
    assert "decimal comma" in problems("frequency,\n361,5\n")["rig.csv:2"]


@pytest.mark.parametrize("text", ["", "# only a comment\n", "\n\n"])
def test_an_empty_file_is_said_to_be_empty(problems, text):
    assert "at least one line" in problems(text)["rig.csv"]


def test_a_header_alone_holds_no_lines(problems):
    assert "at least one rig line" in problems("frequency\n")["rig.csv"]


def test_a_file_that_is_not_there_or_no_text_is_one_clear_problem(tmp_path, read):
    with pytest.raises(ModelError, match="there is no such file"):
        read_rig_lines(tmp_path / "none.csv")
    with pytest.raises(ModelError, match="UTF-8"):
        read("frequency,label\n361,Lager außen\n", encoding="utf-16")
