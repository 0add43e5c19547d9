"""What tests of several files stand on: answers without a solver, a campaign's store."""

import gc
import signal

import fake_solutions
import pytest
from hypothesis import HealthCheck, settings
from matrix_options import scene_files
from matrix_rows import check
from verbs import few_runs, run_here, undraw

from comparisons.sweep import in_process as table
from comparisons.sweep.campaign import campaign
from sheetbench.answers import style
from sheetbench.answers.solution import Solution


def pytest_configure():
    """Ctrl-C is heard in the background too, and by processes of tests; no drawn example has a time limit."""
    gc.set_threshold(20_000, 20, 20)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    settings.register_profile("any machine", deadline=None, suppress_health_check=[HealthCheck.too_slow])
    settings.load_profile("any machine")


def pytest_collection_modifyitems(items):
    """Studies, a browser, five of six rows of a matrix, two of three of a sweep are for `make nightly`."""
    rows = {}
    for item in items:
        if "studies" in item.path.relative_to(item.config.rootpath).parts or "browser" in getattr(
            item, "fixturenames", ()
        ):
            item.add_marker(pytest.mark.nightly)
        sweep, place = item.get_closest_marker("sweep"), (item.path, getattr(item, "originalname", None))
        if "matrix" in item.path.stem and "row" in getattr(getattr(item, "callspec", None), "params", ()):
            sweep, place = pytest.mark.sweep(6), item.path
        if sweep:
            rows[place] = rows.get(place, -1) + 1
            if rows[place] % (sweep.args or (3,))[0]:
                item.add_marker(pytest.mark.nightly)


def pytest_collection_finish():
    """What is imported and collected stays: a tenth of the time went into looking through it for garbage."""
    gc.freeze()


@pytest.fixture
def quick(monkeypatch):
    """Answers without a solver; a test may put its own in."""
    answers: dict[str, Solution] = {}

    def answer(ask, name="", near=None):
        model = ask.spec.model
        size = -0.01 if model == "lumped" else -0.0101
        return answers.get(model) or fake_solutions.solution(ask.scene, name or model, size)

    monkeypatch.setattr(table, "solve", answer)
    return answers


@pytest.fixture(autouse=True)
def coarse_pictures(monkeypatch):
    """Pictures have fewer pixels, for their painting and packing not to take longer than what they show."""
    monkeypatch.setattr(style, "DPI", 60)
    monkeypatch.setattr(style, "PIXELS", 360)


@pytest.fixture
def undrawn(monkeypatch):
    """Pictures are empty files, for tests of what else a run says and leaves."""
    undraw(monkeypatch)


@pytest.fixture
def store(tmp_path):
    with campaign(tmp_path) as opened:
        yield opened


@pytest.fixture
def in_process(monkeypatch):
    """Campaigns run in this process: no worker has to start."""
    run_here(monkeypatch)


@pytest.fixture
def few(monkeypatch):
    """Campaigns run here, and maps have two runs along each axis."""
    few_runs(monkeypatch)


@pytest.fixture(scope="module")
def places(tmp_path_factory):
    """What the matrices' rows have in braces: files by name."""
    return scene_files(tmp_path_factory.mktemp("scenes"))


@pytest.fixture
def ends(places, tmp_path, undrawn, monkeypatch, capsys):
    """Run a command line of the matrices, names in braces filled in, and check how it ends."""
    known = {**places, "folder": str(tmp_path / "out"), "export": str(tmp_path / "export")}

    def ends(*arguments):
        return check([one.format(**known) for one in arguments], monkeypatch, capsys)

    return ends
