"""Named files: what they may be, how large, and what a sentence says where they are something else."""

from __future__ import annotations

import io
import os
import socket
import struct
import zipfile
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest

from rotorgear.files.archive import opened_zip, read_arrays
from rotorgear.files.bounds import LONGEST_TEXT, MOST_DOTS, MOST_MEMBERS
from rotorgear.files.hdf5 import opened_hdf5
from rotorgear.files.numbers import is_count, number_of, whole_of
from rotorgear.files.read import UnreadableError, digest_of_named, named_file, read_named, read_text
from rotorgear.files.shown import shown
from rotorgear.files.toml import long_texts, tables_of

posix = pytest.mark.skipif(os.name == "nt", reason="devices and pipes have names")


def pipe(path: Path) -> Path:
    os.mkfifo(path)
    return path


def door(path: Path) -> Path:
    here = os.getcwd()
    os.chdir(path.parent)  # names of sockets are short
    try:
        socket.socket(socket.AF_UNIX).bind(path.name)
    finally:
        os.chdir(here)
    return path


def sparse(path: Path) -> Path:
    with path.open("wb") as file:
        file.truncate(10**12)
    return path


def link_to_zero(path: Path) -> Path:
    path.symlink_to("/dev/zero")
    return path


@posix
@pytest.mark.parametrize(
    ("make", "reason"),
    [
        (lambda path: Path("/dev/zero"), "a device"),
        (link_to_zero, "a device"),
        (pipe, "a pipe"),
        (door, "a socket"),
        (lambda path: path.parent, "a folder"),
        (sparse, "larger than 1 MB"),
        (lambda path: path, "no such file"),
        (lambda path: path.parent / "a\0b", "null"),
        (lambda path: path.parent / ("x" * 300), "too long"),
    ],
)
@pytest.mark.parametrize("read", [read_named, named_file, digest_of_named, read_text])
def test_what_is_no_small_regular_file_is_refused_at_once(
    tmp_path: Path, make: Callable[[Path], Path], reason: str, read: Callable[[Path, int], object]
) -> None:
    with pytest.raises(UnreadableError, match=reason):
        read(make(tmp_path / "named"), 1_000_000)


def test_a_file_of_the_largest_size_is_read_and_one_byte_more_is_not(tmp_path: Path) -> None:
    path = tmp_path / "a"
    path.write_bytes(b"x" * 10)
    assert read_named(path, 10) == b"x" * 10
    with pytest.raises(UnreadableError, match="larger"):
        read_named(path, 9)


@posix
def test_a_file_of_the_system_that_has_no_size_is_bounded_too() -> None:
    assert Path("/proc/self/status").stat().st_size == 0
    with pytest.raises(UnreadableError, match="larger"):
        read_named("/proc/self/status", 10)


def test_ends_of_lines_of_any_system_and_a_mark_of_byte_order_are_read(tmp_path: Path) -> None:
    path = tmp_path / "a"
    path.write_bytes("\ufeffa\r\nb\rc\n".encode())
    assert read_text(path, 100) == "a\nb\nc\n"
    path.write_bytes(b"ab\xff")
    with pytest.raises(UnreadableError, match="UTF-8: byte 0xff at position 2"):
        read_text(path, 100)


# --- archives ------------------------------------------------------------------------------------------------


def npy(header: str, data: bytes = b"") -> bytes:
    text = header.ljust(117) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(text)) + text.encode() + data


def archive(path: Path, members: dict[str, bytes], method: int = zipfile.ZIP_DEFLATED) -> Path:
    with zipfile.ZipFile(path, "w", method) as file:
        for name, data in members.items():
            file.writestr(name, data)
    return path


@pytest.mark.parametrize(
    ("header", "data"),
    [
        ("{'descr': '<f8', 'fortran_order': False, 'shape': (100000, 100000), }", b""),
        ("{'descr': '<f8', 'fortran_order': False, 'shape': (3,), }", b"x" * 16),
        ("{'descr': '<f8', 'fortran_order': False, 'shape': (1,), }", b"x" * 16),
        ("{'descr': '|S0', 'fortran_order': False, 'shape': (1000000000000,), }", b""),
        ("{'descr': '|O', 'fortran_order': False, 'shape': (1,), }", b"cos\nsystem\n(S'true'\ntR."),
        ("{'descr': '<f8', 'fortran_order': False, 'shape': (-1,), }", b""),
        ("{'descr': '<f8', 'shape': (1,), }", b"x" * 8),
        ("{" + "(" * 90, b""),
    ],
)
def test_an_array_that_is_not_what_its_header_says_is_refused(tmp_path: Path, header: str, data: bytes) -> None:
    with pytest.raises(UnreadableError):
        read_arrays(archive(tmp_path / "a.npz", {"k.npy": npy(header, data)}), 10**9)


def test_arrays_come_back_as_they_were_written(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    given = {
        "plain": rng.random((3, 4)),
        "columns": np.asfortranarray(rng.random((5, 2))),
        "swapped": np.arange(4.0).astype(">f8"),
        "texts": np.array(["ä", "longer"]),
        "one": np.array(7),
        "none": np.zeros((0, 3)),
        "truth": np.array([True, False]),
    }
    for store in (np.savez, np.savez_compressed):
        store(tmp_path / "a.npz", **given)
        found = read_arrays(tmp_path / "a.npz", 10**6)
        assert list(found) == list(given)
        for name, value in given.items():
            assert found[name].dtype == value.dtype
            assert np.array_equal(found[name], value)


def test_archives_beyond_their_bounds_are_refused(tmp_path: Path) -> None:
    many = archive(tmp_path / "many.zip", {f"{k}": b"" for k in range(MOST_MEMBERS + 1)})
    large = archive(tmp_path / "large.zip", {"a": bytes(2_000_000)})
    other = archive(tmp_path / "other.zip", {"a": b"a"}, zipfile.ZIP_LZMA)
    for path, reason in ((many, "more than 1000 files"), (large, "unpacked it is larger"), (other, "another method")):
        with pytest.raises(UnreadableError, match=reason), opened_zip(path, 1_000_000):
            pass


def test_an_archive_that_says_less_than_it_holds_is_refused(tmp_path: Path) -> None:
    path = archive(tmp_path / "a.zip", {"a": bytes(2_000_000)})
    data = bytearray(path.read_bytes())
    for place in (data.find(b"PK\x03\x04") + 22, data.find(b"PK\x01\x02") + 24):
        data[place : place + 4] = struct.pack("<I", 10)
    path.write_bytes(data)
    with pytest.raises(UnreadableError, match="damaged"), opened_zip(path, 1_000_000) as file:
        assert len(file.read("a")) <= 10


# --- HDF5 ----------------------------------------------------------------------------------------------------


def outside(file: h5py.File) -> None:
    file["x"] = h5py.ExternalLink("/etc/hostname", "/")


def soft(file: h5py.File) -> None:
    file["x"] = h5py.SoftLink("/a")


def raw(file: h5py.File) -> None:
    file.create_dataset("x", (3,), "u1", external=[("/etc/passwd", 0, 3)])


def virtual(file: h5py.File) -> None:
    layout = h5py.VirtualLayout((3,), "f8")
    layout[:] = h5py.VirtualSource("/tmp/other.h5", "x", (3,))
    file.create_virtual_dataset("x", layout)


def twice(file: h5py.File) -> None:
    group = file.create_group("g")
    group["again"] = file["a"]


def circle(file: h5py.File) -> None:
    group = file.create_group("g")
    group["up"] = group


def packed(file: h5py.File) -> None:
    file.create_dataset("x", (10**6,), "f8", compression="gzip", chunks=(10**5,))


@pytest.mark.parametrize("change", [outside, soft, raw, virtual, twice, circle, packed])
def test_no_way_leads_out_of_a_file_of_hdf5(tmp_path: Path, change: Callable[[h5py.File], None]) -> None:
    path = tmp_path / "a.h5"
    with h5py.File(path, "w") as file:
        file["a"] = np.arange(3.0)
    with opened_hdf5(path, 10**6) as file:
        assert file["a"][2] == 2.0
    with h5py.File(path, "r+") as file:
        change(file)
    with pytest.raises(UnreadableError), opened_hdf5(path, 10**6):
        pass


# --- texts and numbers ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("line", ["a{}=1", "[a{}]", "x={{a{}=1}}", '"a"{}=1', "a{}=1\r"])
def test_a_key_of_many_parts_is_refused_in_time_that_grows_with_its_length(line: str) -> None:
    for parts in ('."b"', ".b", " . 'b'"):
        with pytest.raises(ValueError, match="more than 64 parts"):
            tables_of(line.format(parts * 100_000))
    assert tables_of(line.format(".b" * MOST_DOTS).replace("\r", ""))


def test_dots_of_numbers_and_texts_are_none_of_a_key() -> None:
    text = f"a = [{', '.join(['1.5'] * 1000)}]\nb = '{'.' * 500}'\nc = \"a.{'b.' * 200}\"\n"
    assert len(tables_of(text)["a"]) == 1000


def test_long_texts_and_names_are_found_wherever_they_stand() -> None:
    long = "x" * (LONGEST_TEXT + 1)
    assert list(long_texts({"a": [{"b": long}], "c": long[1:]})) == [("a", 0, "b")]
    assert list(long_texts({"a": {long: 1}})) == [("a", long)]


@pytest.mark.parametrize(
    "text", ["1_0", "٣", "²", "0x10", "1e", "", " ", "1,5", "--1", "1e5_0", "infinity", "nan", "1" * 200]
)
def test_what_pages_do_not_write_is_no_number(text: str) -> None:
    with pytest.raises(ValueError, match="no number"):
        number_of(text)
    with pytest.raises(ValueError, match="no whole number"):
        whole_of(text)
    assert not is_count(text)


@pytest.mark.parametrize("text", ["1", "-1.5", "+.5e-3", " 2. ", "1E5", "007"])
def test_numbers_are_those_of_python(text: str) -> None:
    assert number_of(text) == float(text)


def test_whole_numbers_have_the_digits_of_an_array() -> None:
    assert whole_of("-12") == -12
    assert is_count("012")
    for text in ("9" * 19, "1.0"):
        with pytest.raises(ValueError, match="no whole number"):
            whole_of(text)


def test_a_terminal_gets_nothing_that_it_obeys() -> None:
    text = "a\x1b[2J\x07b\x9b31m\u202ec\rd\x00\x7f\u2066"
    assert not any(letter in shown(text) for letter in "\x1b\x07\x9b\u202e\r\x00\x7f\u2066")
    assert shown("Zahnräder 歯車\t🦷\n") == "Zahnräder 歯車\t🦷\n"
    assert io.StringIO(shown(text)).read().count("\ufffd") == 8
