"""Pictures: text of scenes is no mathematics, names do not overlap, loads and actuators are seen."""

import matplotlib
import numpy as np
import pytest
from matplotlib.figure import Figure

from comparisons.pictures.labels import place_labels
from sheetbench.answers import history_figure as motion
from sheetbench.answers.history import ENERGIES, History
from sheetbench.answers.solution import Status
from sheetbench.answers.style import MOST, STYLE, plain, save

HOSTILE = "T $\\foo$ \x1b[31m _x^y\n$"


@pytest.mark.parametrize("suffix", ["png", "pdf", "svg"])
def test_text_of_a_scene_is_no_mathematics(tmp_path, suffix):
    figure = Figure()
    figure.suptitle(plain(HOSTILE, width=10))
    with matplotlib.rc_context(STYLE):
        save(figure, [tmp_path / f"a.{suffix}"])
    assert [path.name for path in tmp_path.iterdir()] == [f"a.{suffix}"]
    assert "\x1b" not in plain(HOSTILE)


def test_names_of_near_points_stand_apart():
    figure = Figure(figsize=(7.2, 3.0))
    axis = figure.add_axes((0.0, 0.0, 1 / 3, 1.0))
    axis.imshow(np.zeros((1200, 1000)))
    near = np.array([[500.0, 600.0], [506.0, 603.0], [510.0, 598.0], [985.0, 600.0]])
    place_labels(axis, near, ["one", "two", "three", "a name that is far too long for a panel"])
    figure.draw_without_rendering()
    boxes = [text.get_window_extent() for text in axis.texts]
    panel = axis.get_window_extent()
    assert all(box.x0 >= panel.x0 and box.x1 <= panel.x1 for box in boxes)
    for i, first in enumerate(boxes):
        assert not any(first.overlaps(second) for second in boxes[i + 1 :])


def history(probes):
    time = np.linspace(0.0, 1.0, 5)
    moved = {f"p{i} $": np.outer(time, [0.0, 0.0, 1e-3 * i]) for i in range(probes)}
    energies = dict.fromkeys(ENERGIES, time)
    return History("lumped", "verlet", {}, Status.CONVERGED, "", time, moved, energies, {}, {}, 4, 0.0, 0.0)


def test_many_probes_have_a_dozen_panels_of_those_that_move_most():
    figure = motion.compose(history(250), HOSTILE, {})
    titles = [axis.get_title(loc="left") for axis in figure.axes]
    assert len(figure.axes) == MOST + 1
    assert titles[0] == plain("p238 $") and titles[MOST - 1] == plain("p249 $")
