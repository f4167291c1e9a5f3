from dataclasses import fields, is_dataclass, replace

import numpy as np
import pytest

from rotorgear.export import hdf5
from rotorgear.export.hdf5 import ReadError, read, save
from rotorgear.files.write import WriteError
from rotorgear.model.model import Model
from tests.unit.export.small_models import CHAIN, HERRINGBONE, PAIR, modes_of

h5py = pytest.importorskip("h5py")


def assert_same(one, other, where="result"):
    """Same types, same values to the last bit, NaN equal to NaN."""
    assert type(one) is type(other), where
    if isinstance(one, Model):
        assert one == other, where
        assert one.model_dump_json() == other.model_dump_json()
    elif is_dataclass(one):
        for item in fields(one):
            assert_same(getattr(one, item.name), getattr(other, item.name), f"{where}.{item.name}")
    elif isinstance(one, np.ndarray):
        assert (one.dtype, one.shape) == (other.dtype, other.shape), where
        assert one.tobytes() == other.tobytes(), where
    elif isinstance(one, dict):
        assert list(one) == list(other), where
        for key in one:
            assert_same(one[key], other[key], f"{where}[{key}]")
    elif isinstance(one, tuple):
        assert len(one) == len(other), where
        for k, (first, second) in enumerate(zip(one, other, strict=True)):
            assert_same(first, second, f"{where}[{k}]")
    else:
        assert one == other, where


@pytest.mark.parametrize("text", [PAIR, HERRINGBONE, CHAIN])
@pytest.mark.parametrize("speed", [None, 628.3185307179587])
def test_a_result_comes_back_to_the_last_bit(tmp_path, text, speed):
    result = modes_of(text, speed)
    assert save(result, tmp_path / "result.h5") == tmp_path / "result.h5"
    assert_same(result, read(tmp_path / "result.h5"))


def test_names_with_slashes_and_other_scripts_and_what_is_not_finite_come_back(tmp_path):
    result = modes_of(PAIR)
    shares = {"shafts.a/b": np.array([0.1, np.nan, -0.0, np.inf]), "gears.二": np.array([1.0, 2.0, 3.0, 4.0])}
    estimate = np.array([np.nan, np.inf, 1e-300, 0.3])
    odd = replace(result, kinetic_energy=shares, error_estimate=estimate, description=("", "ä\n二", " x ", '"<&>"'))
    save(odd, tmp_path / "odd.h5")
    assert_same(odd, read(tmp_path / "odd.h5"))


def test_saving_again_replaces_the_file_and_leaves_nothing_beside_it(tmp_path):
    for text in (PAIR, CHAIN):
        save(modes_of(text), tmp_path / "result.h5")
        assert read(tmp_path / "result.h5").model.title == modes_of(text).model.title
    assert [path.name for path in tmp_path.iterdir()] == ["result.h5"]


def test_a_failure_halfway_leaves_the_old_file_as_it_was(tmp_path, monkeypatch):
    save(modes_of(PAIR), tmp_path / "result.h5")
    before = (tmp_path / "result.h5").read_bytes()

    def refuse(h5, parent, name, value):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(hdf5, "put_value", refuse)
    with pytest.raises(WriteError, match="no space left on device"):
        save(modes_of(CHAIN), tmp_path / "result.h5")
    assert (tmp_path / "result.h5").read_bytes() == before
    assert [path.name for path in tmp_path.iterdir()] == ["result.h5"]


def test_places_where_no_file_can_be_are_reported(tmp_path):
    with pytest.raises(WriteError, match="it is a folder; give the name of a file"):
        save(modes_of(PAIR), tmp_path)
    with pytest.raises(WriteError, match="there is no folder"):
        save(modes_of(PAIR), tmp_path / "none" / "result.h5")
    assert list(tmp_path.iterdir()) == []


def test_a_saved_file_has_the_permissions_of_any_new_file(tmp_path):
    (tmp_path / "plain").touch()
    save(modes_of(PAIR), tmp_path / "result.h5")
    assert (tmp_path / "result.h5").stat().st_mode == (tmp_path / "plain").stat().st_mode


def test_what_is_no_result_is_said_to_be_none(tmp_path):
    with pytest.raises(ReadError, match=r"absent\.h5 can't be read: there is no such file"):
        read(tmp_path / "absent.h5")
    with pytest.raises(ReadError, match="it is a folder"):
        read(tmp_path)
    (tmp_path / "text.h5").write_text("frequency_hz,1", encoding="utf-8")
    with pytest.raises(ReadError, match="it is no HDF5 file, or damaged"):
        read(tmp_path / "text.h5")
    with h5py.File(tmp_path / "foreign.h5", "w") as file:
        file["frequency"] = np.arange(3.0)
    with pytest.raises(ReadError, match="it is no result of rotorgear"):
        read(tmp_path / "foreign.h5")


def test_a_file_of_a_newer_format_names_the_version_that_wrote_it(tmp_path):
    save(modes_of(PAIR), tmp_path / "new.h5")
    with h5py.File(tmp_path / "new.h5", "a") as file:
        file.attrs["format_version"] = hdf5.FORMAT_VERSION + 1
        file.attrs["rotorgear_version"] = "77.1"
    with pytest.raises(ReadError, match=r"written by rotorgear 77\.1 in format 2 .*reads format 1; use the newer one"):
        read(tmp_path / "new.h5")


@pytest.mark.parametrize("damage", ["shapes", "nodes/position", "model"])
def test_a_file_with_a_part_missing_is_damaged(tmp_path, damage):
    save(modes_of(PAIR), tmp_path / "hole.h5")
    with h5py.File(tmp_path / "hole.h5", "a") as file:
        del file[damage]
    with pytest.raises(ReadError, match="it is damaged"):
        read(tmp_path / "hole.h5")


def test_a_file_that_was_cut_off_is_damaged(tmp_path):
    save(modes_of(PAIR), tmp_path / "cut.h5")
    content = (tmp_path / "cut.h5").read_bytes()
    (tmp_path / "cut.h5").write_bytes(content[: len(content) // 2])
    with pytest.raises(ReadError, match="damaged"):
        read(tmp_path / "cut.h5")


def test_a_model_that_no_longer_passes_the_checks_is_reported_with_its_problems(tmp_path):
    save(modes_of(PAIR), tmp_path / "old.h5")
    with h5py.File(tmp_path / "old.h5", "a") as file:
        text = file["model"].asstr()[()].replace('"teeth":24', '"teeth":0')
        file["model"][()] = text
    with pytest.raises(ReadError, match=r"(?s)does not pass the checks.*gears\.pinion\.teeth"):
        read(tmp_path / "old.h5")
