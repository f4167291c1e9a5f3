"""Records as programs write them: tables of every kind, and files of measuring systems that the packages themselves wrote."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

from rotorgear.errors import ModelError
from rotorgear.records.read import read_record
from rotorgear.records.record import Channel, TimeRecord


def table(folder: Path, text: str, encoding: str = "utf-8", name: str = "record.csv") -> Path:
    file = folder / name
    file.write_bytes(text.encode(encoding))
    return file


@pytest.mark.parametrize(
    ("text", "encoding", "time", "channels"),
    [
        ("time_s,torque_Nm\n0,1.5\n0.5,-2e1\n", "utf-8", [0.0, 0.5], [("torque", "Nm", [1.5, -20.0])]),
        (
            "ms,motor N m,u (N m)\n-20,1,2\n-15,3,4\n",
            "utf-8",
            [-0.02, -0.015],
            [("motor", "N m", [1, 3]), ("u", "N m", [2, 4])],
        ),
        (
            "Messung 3;\nDatum;1.2.2020\n\n# Prüfstand\nZeit [ms];Beschl. links [m/s²];Kraft_kN\n0,0;1,5;2\n0,5;1,25;-3,5e1\n",
            "cp1252",
            [0.0, 0.0005],
            [("Beschl. links", "m/s2", [1.5, 1.25]), ("Kraft", "kN", [2.0, -35.0])],
        ),
        ("time\tacc\ns\tg\n0\t1\n1\t2\n", "utf-16", [0.0, 1.0], [("acc", "g", [1.0, 2.0])]),
        ("t x a_b\n0 1 2\n1 2 3\n", "utf-8", [0.0, 1.0], [("x", "", [1.0, 2.0]), ("a_b", "", [2.0, 3.0])]),
        ('"time / ms";"w in um"\n"0,5";"1"\n"1,5";"2"\n', "utf-8-sig", [5e-4, 15e-4], [("w", "um", [1.0, 2.0])]),
        ("x (mm);time (min);\n1;0;\n2;1;\n", "utf-8", [0.0, 60.0], [("x", "mm", [1.0, 2.0])]),
        ("time,p (bar)\n0,1\n1,2\n", "utf-8", [0.0, 1.0], [("p", "bar", [1.0, 2.0])]),
    ],
)
def test_tables_of_every_kind(
    tmp_path: Path, text: str, encoding: str, time: list[float], channels: list[tuple[str, str, list[float]]]
) -> None:
    found = read_record(table(tmp_path, text, encoding))
    np.testing.assert_allclose(found.time, time, rtol=1e-15)
    assert [(one.name, one.unit, one.values.tolist()) for one in found.channels] == channels


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "no line of it holds two numbers"),
        # Minutes to a pattern that goes back and forth over the blanks.
        ("time a\n0 1\n0.1" + 3000 * " " + "x\n0.2 3\n", "expected a number in each cell"),
        ("hello\nworld", "no line of it holds two numbers"),
        ("0,1\n1,2\n", "no names stand above it"),
        ("a,b\n0,1\n1,2\n", "one column of time, such as 'time_s'"),
        ("time,time (ms),b\n0,1,2\n1,2,3\n", "2 of them.*one column of time"),
        ("time,b\n0,1\n0,2\n", r"record.csv:3:time: times that rise"),
        ("time,b\n0,1\n1,2\n0.5,2\n", r"record.csv:4:time: times that rise"),
        ("time,b\n0,1\n", "two rows or more"),
        ("time,b\n0,1\n1,\n", r"record.csv:3: .*leave out rows in which a channel has no value"),
        ("time,b\n0,1\n1,two\n2,3\n", r"record.csv:3: got 'two', expected a number in each cell"),
        ("time,b\n0,1\n1,nan\n", "got 'nan'"),
        ("time,b\n0,1\n1,2,3\n", "record.csv:3: got 3 of them, expected 2 numbers"),
        ("time,b\n0,1\n1,1e999\n", "numbers that a computer can hold"),
        ("time;b\n0,5;1.234,5\n1;2\n", "record.csv:2|no line"),
    ],
)
def test_tables_that_are_none_are_refused_in_one_sentence(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(ModelError, match=words) as error:
        read_record(table(tmp_path, text))
    assert len(error.value.problems) == 1


def test_what_is_no_file_is_refused(tmp_path: Path) -> None:
    for name in ("none.csv", "none.mf4", "none.tdms", "none.wav"):
        with pytest.raises(ModelError, match="there is no such file"):
            read_record(tmp_path / name)
    with pytest.raises(ModelError, match="it is a folder"):
        read_record(tmp_path)


TIME = 0.1 + 0.01 * np.arange(50)
TORQUE = np.sin(9.0 * TIME)


def write_mdf(file: Path, compression: int = 0) -> Path:
    from asammdf import MDF, Signal

    with MDF(version="4.10") as mdf:
        raw = Signal((1000.0 * TORQUE).astype("i2"), TIME, name="raw", unit="V", conversion={"a": 2e-3, "b": 1.0})
        worded = Signal(np.arange(50), TIME, name="state", conversion={"val_0": 0, "text_0": b"off", "default": b"on"})
        run = Signal(TORQUE, TIME, name="formula", conversion={"formula": "X1 * 2"})
        mdf.append([Signal(TORQUE, TIME, name="torque", unit="Nm"), raw, worded, run])
        mdf.append([Signal(TORQUE[::5], TIME[::5], name="slow", unit="N")])
        mdf.save(file, overwrite=True, compression=compression)
    return file


def write_tdms(file: Path) -> Path:
    from nptdms import ChannelObject, TdmsWriter

    timed = {"wf_increment": 0.01, "wf_start_offset": 0.1, "unit_string": "N m"}
    with TdmsWriter(file) as writer:
        writer.write_segment(
            [
                ChannelObject("bench", "torque", TORQUE, properties=timed),
                ChannelObject("logger", "Time", TIME),
                ChannelObject("logger", "force", 2.0 * TORQUE, properties={"unit_string": "N"}),
                ChannelObject("logger", "names", ["a"] * 50),
            ]
        )
    return file


def write_wav(file: Path) -> Path:
    import soundfile

    soundfile.write(file, np.column_stack([0.5 * TORQUE, -0.25 * TORQUE]), 100, subtype="DOUBLE")
    return file


@pytest.mark.parametrize("compression", [0, 2])
def test_mdf_has_its_factors_and_rates_and_no_formulas(tmp_path: Path, compression: int) -> None:
    pytest.importorskip("asammdf")
    found = read_record(write_mdf(tmp_path / "bench.mf4", compression))
    torque, raw, slow = found.channels
    assert [(one.name, one.unit) for one in found.channels] == [("torque", "Nm"), ("raw", "V"), ("slow", "N")]
    inside = TIME[45] + 1e-9 >= TIME
    np.testing.assert_allclose(found.time, TIME[inside])
    np.testing.assert_allclose(torque.values, TORQUE[inside])
    np.testing.assert_allclose(raw.values, 1.0 + 2e-3 * np.trunc(1000.0 * TORQUE[inside]))
    np.testing.assert_allclose(slow.values[::5], TORQUE[:46:5])
    assert found.notes == ("1 of 3 channels were measured at other times: taken from those by straight lines",)


def test_tdms_has_times_by_properties_and_by_a_channel(tmp_path: Path) -> None:
    pytest.importorskip("nptdms")
    found = read_record(write_tdms(tmp_path / "bench.tdms"))
    assert [(one.name, one.unit) for one in found.channels] == [("bench/torque", "N m"), ("logger/force", "N")]
    np.testing.assert_allclose(found.time, TIME)
    np.testing.assert_allclose(found.channels[1].values, 2.0 * found.channels[0].values)


@pytest.mark.parametrize(("package", "write", "name"), [("nptdms", "tdms", "a.tdms"), ("soundfile", "wav", "a.wav")])
def test_records_that_break_off_are_refused_without_a_word_beside(
    tmp_path: Path, package: str, write: str, name: str, capfd: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip(package)
    file = {"tdms": write_tdms, "wav": write_wav}[write](tmp_path / name)
    whole = file.read_bytes()
    file.write_bytes(whole[: int(0.8 * len(whole))])
    with pytest.raises(ModelError, match="it ends before what it says it holds"):
        read_record(file)
    assert capfd.readouterr() == ("", "")
    if write == "wav":  # a logger that streams leaves the size open
        file.write_bytes(whole[:4] + 4 * b"\xff" + whole[8:])
        assert len(read_record(file).time) == 50


def test_tdms_without_an_offset_begins_at_its_start(tmp_path: Path) -> None:
    pytest.importorskip("nptdms")
    from nptdms import ChannelObject, TdmsWriter

    with TdmsWriter(tmp_path / "a.tdms") as writer:
        writer.write_segment([ChannelObject("g", "torque", TORQUE, properties={"wf_increment": 0.01})])
    np.testing.assert_allclose(read_record(tmp_path / "a.tdms").time, TIME - 0.1, atol=1e-12)


def test_wav_has_shares_of_full_scale(tmp_path: Path) -> None:
    pytest.importorskip("soundfile")
    found = read_record(write_wav(tmp_path / "box.wav"))
    assert [(one.name, one.unit) for one in found.channels] == [("1", ""), ("2", "")]
    np.testing.assert_allclose(found.channels[1].values, -0.25 * TORQUE, atol=1e-12)
    np.testing.assert_allclose(found.time, 0.01 * np.arange(50))


@pytest.mark.parametrize(
    ("package", "write", "name"),
    [("asammdf", write_mdf, "a.mf4"), ("nptdms", write_tdms, "a.tdms"), ("soundfile", write_wav, "a.wav")],
)
def test_broken_files_are_read_or_refused_and_nothing_else(
    tmp_path: Path, package: str, write, name: str, capsys
) -> None:  # type: ignore[no-untyped-def]
    pytest.importorskip(package)
    whole = write(tmp_path / name).read_bytes()
    rng = np.random.default_rng(7)
    # MDF is read by a process of its own each time, since some of these end it.
    apart = package == "asammdf"
    broken = [whole[:cut] for cut in ([len(whole) // 2] if apart else [0, 5, len(whole) // 2])]
    for _ in range(2 if apart else 10):
        data = bytearray(whole)
        for place in rng.integers(len(whole), size=3):
            data[place] = int(rng.integers(256))
        broken.append(bytes(data))
    refused = 0
    for data in broken:
        (tmp_path / name).write_bytes(data)
        found = None
        with suppress(ModelError):
            found = read_record(tmp_path / name)
        refused += found is None
        assert found is None or all(np.isfinite(one.values).all() for one in found.channels)
    assert refused > (0 if apart else 2)
    printed = capsys.readouterr()
    assert printed.out + printed.err == ""


def test_a_packed_block_that_is_larger_than_it_says_is_not_unpacked(tmp_path: Path) -> None:
    pytest.importorskip("asammdf")
    file = write_mdf(tmp_path / "bench.mf4", 1)
    data = file.read_bytes()
    at = data.index(b"##DZ")
    for size in (7, 10**12):
        file.write_bytes(data[: at + 32] + size.to_bytes(8, "little") + data[at + 40 :])
        with pytest.raises(ModelError, match=r"packed blocks that hold what they say|that unpack to"):
            read_record(file)


def test_a_record_of_python_is_as_good() -> None:
    assert TimeRecord(TIME, (Channel("torque", "N m", TORQUE),)).channels[0].values[3] == TORQUE[3]
