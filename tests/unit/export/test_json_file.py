import json
import os

import pytest

from rotorgear.errors import RotorgearError
from rotorgear.files.write import WriteError, write_json
from tests.unit.export.small_models import PAIR, modes_of


def test_a_result_written_as_json_reads_back_to_the_last_digit(tmp_path):
    data = modes_of(PAIR, 600.0).to_dict()
    write_json(data, tmp_path / "result.json")
    assert json.loads((tmp_path / "result.json").read_text(encoding="utf-8")) == json.loads(json.dumps(data))


def test_text_stays_readable(tmp_path):
    write_json({"name": "Wälzlager 二"}, tmp_path / "a.json")
    assert "Wälzlager 二" in (tmp_path / "a.json").read_bytes().decode("utf-8")


@pytest.mark.parametrize("value", [float("nan"), float("inf"), {1, 2}])
def test_what_json_does_not_know_is_refused_and_the_old_file_stays(tmp_path, value):
    write_json({"x": 1}, tmp_path / "a.json")
    with pytest.raises(RotorgearError, match=r"a\.json can't be written as JSON"):
        write_json({"x": value}, tmp_path / "a.json")
    assert json.loads((tmp_path / "a.json").read_text(encoding="utf-8")) == {"x": 1}
    assert [path.name for path in tmp_path.iterdir()] == ["a.json"]


def test_a_folder_in_the_way_is_reported(tmp_path):
    with pytest.raises(WriteError, match="it is a folder"):
        write_json({}, tmp_path)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes here")
def test_a_pipe_is_written_to_and_not_replaced(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    try:
        write_json({"x": 1}, pipe)
        assert json.loads(os.read(reader, 1000)) == {"x": 1}
    finally:
        os.close(reader)
    assert pipe.is_fifo()
