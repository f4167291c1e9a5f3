import os
import sys
from types import SimpleNamespace

import numpy as np
import pytest

from rotorgear.errors import AnalysisError, MissingExtraError
from rotorgear.files.write import WriteError
from rotorgear.plots import scene, view
from rotorgear.plots.mode_pictures import write_modes
from rotorgear.plots.scene import RenderError, Scene, colour_map, headline, rendering, working_window
from tests.unit.export.small_models import CHAIN, PAIR, modes_of

pv = pytest.importorskip("pyvista")


@pytest.fixture(scope="module")
def pictures(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pictures")
    try:
        return write_modes(modes_of(PAIR), folder, modes=[1, 2], size=(480, 300))
    except RenderError as error:
        pytest.skip(str(error))


def pixels(path):
    return pv.read(path).active_scalars.reshape(300, 480, -1)[..., :3].astype(int)


def test_pictures_have_the_size_that_was_asked_for_and_show_the_gearbox_in_colour(pictures):
    assert [path.name for path in pictures] == ["mode_02.png", "mode_03.png"]
    for path in pictures:
        picture = pixels(path)
        drawn = np.any(picture < 240, axis=-1)
        assert 0.15 < np.mean(drawn) < 0.8
        assert np.count_nonzero(np.ptp(picture, axis=-1) > 80) > 300, "what moves most is in strong colours"
        rows = np.flatnonzero(drawn.any(axis=1))
        columns = np.flatnonzero(drawn.any(axis=0))
        assert rows[0] > 0, "nothing is cut off"
        assert columns[-1] < 479


def test_pictures_of_two_modes_differ(pictures):
    one, two = (pixels(path) for path in pictures)
    assert np.mean(np.any(np.abs(one - two) > 20, axis=-1)) > 0.02


def test_a_torsion_only_chain_without_shafts_can_be_drawn(tmp_path, pictures):
    (path,) = write_modes(modes_of(CHAIN), tmp_path, modes=[1], size=(480, 300))
    assert np.mean(np.any(pixels(path) < 240, axis=-1)) > 0.03


def test_drawing_leaves_the_environment_as_it_was(pictures):
    before = dict(os.environ)
    with rendering():
        pass
    assert dict(os.environ) == before


@pytest.fixture
def broken_graphics(monkeypatch):
    """Every trial of this test ends as a crash does."""
    working_window.cache_clear()
    monkeypatch.setattr(scene, "_TRIAL", "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)")
    yield
    working_window.cache_clear()


@pytest.mark.skipif(sys.platform == "win32", reason="no such signal")
def test_where_rendering_crashes_the_command_says_so_and_lives(tmp_path, broken_graphics):
    with pytest.raises(RenderError, match=r"can't be rendered on this machine .*a crash.*libegl1.*ParaView"):
        write_modes(modes_of(PAIR), tmp_path, modes=[0])
    assert list(tmp_path.iterdir()) == []


def test_a_trial_that_hangs_is_given_up(monkeypatch):
    monkeypatch.setattr(scene, "_TRIAL", "import time; time.sleep(60)")
    monkeypatch.setattr(scene, "_TIMEOUT", 0.2)
    assert scene.can_render("") == "no answer in 0 s"


def test_a_trial_that_draws_nothing_is_no_success(monkeypatch):
    monkeypatch.setattr(scene, "_TRIAL", "raise SystemExit(3)")
    assert scene.can_render("") == "no picture"


def test_wishes_that_make_no_sense_are_refused(tmp_path):
    with pytest.raises(AnalysisError, match="there is no mode 9: the result has 4"):
        write_modes(modes_of(PAIR), tmp_path, modes=[8])
    with pytest.raises(AnalysisError, match="at least 100 pixels each way, got 1600 x 40"):
        write_modes(modes_of(PAIR), tmp_path, size=(1600, 40))
    with pytest.raises(AnalysisError, match="the amplitude is a positive share"):
        write_modes(modes_of(PAIR), tmp_path, amplitude=-1.0)


def test_a_file_in_the_way_of_the_folder_is_reported(tmp_path):
    (tmp_path / "taken").touch()
    with pytest.raises(WriteError, match="a file stands in the way"):
        write_modes(modes_of(PAIR), tmp_path / "taken", modes=[0])


def test_without_pyvista_the_extra_to_install_is_named(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(MissingExtraError, match=r"pyvista.*rotorgear\[vtk\]"):
        write_modes(modes_of(PAIR), tmp_path)
    with pytest.raises(MissingExtraError, match=r"pyvista.*rotorgear\[vtk\]"):
        view.view(modes_of(PAIR))


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="X11 only")
def test_without_a_display_the_window_says_what_works_instead(monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    for shown in (modes_of(PAIR), modes_of(PAIR).model):
        with pytest.raises(RenderError, match=r"there is none here \(DISPLAY is not set\); use modal --plot"):
            view.view(shown)
    monkeypatch.setenv("DISPLAY", ":987")
    with pytest.raises(RenderError, match=r"no window can open on the display :987"):
        view.view(modes_of(PAIR))
    with pytest.raises(AnalysisError, match="there is no mode 12"):
        view.view(modes_of(PAIR), mode=11)


def test_a_model_that_was_not_analysed_has_nodes_to_be_seen_with():
    from rotorgear.export.solids import build_solids

    for text in (PAIR, CHAIN):
        result = modes_of(text)
        shown = build_solids(result.model, view._nodes(result.model))
        assert np.array_equal(shown.points, build_solids(result.model, result.nodes).points)


def player_of(text):
    from rotorgear.export.solids import build_solids

    result = modes_of(text, 600.0)
    drawn = []
    plotter = SimpleNamespace(render=lambda: drawn.append(1), add_text=lambda *a, **k: None, window_size=(800, 500))
    return view.Player(plotter, Scene(pv, build_solids(result.model, result.nodes), result), 0), drawn


def test_the_player_changes_modes_in_a_ring_and_stops():
    player, drawn = player_of(PAIR)
    player.choose(player.mode - 1)
    assert player.mode == 3
    player.choose(player.mode + 1)
    assert player.mode == 0
    count = len(drawn)
    player.toggle()
    player.step()
    assert (player.frame, len(drawn)) == (0, count)
    player.toggle()
    player.step()
    assert (player.frame, len(drawn)) == (1, count + 1)


def test_the_player_shows_the_shape_at_its_phase_and_size():
    player, _ = player_of(PAIR)
    player.choose(2)
    layer = player.scene.moving
    player.frame = 0
    player.resize(0.1)
    moved = layer.mesh.points - layer.rest
    assert np.allclose(moved, 2.0 * player.scaled.real[layer.numbers], rtol=0.0, atol=1e-6)
    player.frame = 25
    player.draw()
    assert np.allclose(layer.mesh.points - layer.rest, -moved, rtol=0.0, atol=1e-6)


def test_the_headline_names_mode_frequency_damping_and_whirl():
    still = modes_of(PAIR)
    spinning = modes_of(PAIR, 600.0)
    assert headline(still, 0).startswith("Mode 1:  rigid body, 0 Hz\n")
    assert headline(still, 2) == f"Mode 3:  {still.frequency_hz[2]:.1f} Hz\n{still.description[2]}"
    assert f"damping {100.0 * spinning.damping_ratio[2]:.2f} %" in headline(spinning, 2)


def test_colours_go_from_grey_to_red():
    colours = colour_map()
    assert (len(colours), colours[0], colours[-1]) == (256, "#c3ccd6", "#c4201f")
