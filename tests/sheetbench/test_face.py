"""The face in Python: quick to import, one name for everything, and a scene is a scene, a name or a path."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from commands import python

import fem_reference
import lumped
import sheetbench as sb

NAME = "one-edge-clamped"
HEAVY = ["numpy", "scipy", "pydantic", "numba", "skfem", "meshio", "pyvista", "vtkmodules", "matplotlib"]
HEAVY += ["rich", "typer", "lumped", "fem_reference", "comparisons", "sheetbench.scenes"]


def printed(*arguments, **environment):
    """What a fresh interpreter prints."""
    done = python(*arguments, **environment)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_importing_sheetbench_imports_nothing_heavy_and_a_scene_is_read_without_any_solver():
    code = "import sys, sheetbench as sb; print([m for m in sys.argv[1:] if m in sys.modules])"
    code += f"; sb.load('{NAME}'); print([m for m in sys.argv[1:] if m in sys.modules])"
    imported, read = printed("-c", code, *HEAVY).splitlines()
    assert imported == "[]" and read == str(["numpy", "pydantic", "sheetbench.scenes"])


def test_public_names_exist_and_are_listed():
    for name in sb.__all__:
        assert getattr(sb, name) is not None
    assert [name for name in dir(sb) if not name.startswith("__")] == sorted(sb.__all__)
    assert sb.__version__ == "0.1.0"
    with pytest.raises(AttributeError, match="no attribute 'weigh'"):
        sb.weigh  # noqa: B018


def test_a_users_own_modules_do_not_shadow_ours(tmp_path):
    for taken in ("scenes.py", "report.py", "models.py", "catalogue.py"):
        (tmp_path / taken).write_text("raise SystemExit('mine')\n")
    script = tmp_path / "run.py"
    script.write_text(f"import sheetbench as sb\nprint(sb.load('{NAME}').name)\n")
    assert printed(str(script)) == NAME


def test_compiled_kernels_are_kept_outside_the_packages(tmp_path):
    ask = "import sheetbench.kernels as k; print(k.folder(k.__file__).parent.parent)"
    forget = "import os; os.environ.pop('NUMBA_CACHE_DIR', None); "
    assert printed("-c", forget + ask, XDG_CACHE_HOME=str(tmp_path)) == str(tmp_path / "sheetbench")
    theirs = str(tmp_path / "theirs")
    assert printed("-c", ask, NUMBA_CACHE_DIR=theirs) == theirs


VERBS: dict[str, Callable[[Any], Any]] = {
    "sb.calibrate": lambda scene: sb.calibrate(scene, grid=3).springs.axial,
    "sb.solve": lambda scene: sb.solve(scene, grid=3).displacement([[0.1, 0.1]]),
    "sb.solve shell": lambda scene: sb.solve(scene, "shell", elements=2).displacement([[0.1, 0.1]]),
    "sb.compare": lambda scene: (
        sb.compare(scene, grid=3, elements=2, uncertainty=False).differences[0].relative
    ),
    "sb.modes": lambda scene: sb.modes(scene, grid=3, count=2, elements=2)[0].frequencies,
    "sb.simulate": lambda scene: sb.simulate(scene, 1e-3, grid=3).probes["P4"][-1],
    "sb.check": lambda scene: sb.check(scene).tables()[0].rows,
    "lumped.solve": lambda scene: lumped.solve(scene, sb.calibrate(NAME, grid=3)).displacement([[0.1, 0.1]]),
    "lumped.modes": lambda scene: lumped.modes(scene, sb.calibrate(NAME, grid=3), 2).frequencies,
    "lumped.simulate": lambda scene: lumped.simulate(scene, sb.calibrate(NAME, grid=3), 1e-3).time,
    "fem_reference.solve": lambda scene: fem_reference.solve(scene, elements=2).displacement([[0.1, 0.1]]),
    "fem_reference.modes": lambda scene: fem_reference.modes(scene, elements=2, count=2).frequencies,
}


@pytest.mark.sweep(2)
@pytest.mark.parametrize("verb", VERBS)
def test_a_scene_a_name_and_a_path_are_the_same_to_every_verb(tmp_path, verb):
    scene = sb.load(NAME)
    path = tmp_path / "saved.toml"
    scene.save(path)
    ask = VERBS[verb]
    expected = ask(scene)
    for other in (NAME, path, str(path)):
        assert np.all(np.asarray(ask(other) == expected))


@pytest.mark.parametrize("verb", ["calibrate", "check", "compare", "modes", "solve", "tradeoff"])
def test_a_name_that_is_none_is_refused(verb):
    with pytest.raises(sb.SceneError, match="no-such-sheet: no such file"):
        getattr(sb, verb)("no-such-sheet")


def test_a_saved_scene_holds_every_digit(tmp_path):
    way = [[0.0] * 3, [0.01, 0.0, 0.0]]
    moved = sb.EdgeMotion(kind="motion", time=[0.0, 1.0], edge="x1", displacement=way)
    scene = sb.Scene(
        name='it\'s "quoted"',
        sheet=sb.Sheet(0.1 + 0.2, 0.2, 1e-3 / 3),
        material=sb.Material(1e6 / 7, 0.3, 1e3),
        loads=[sb.Pressure(value=1e-9, history={"time": [0.0, 0.1], "factor": [0.0, 1.0]})],
        supports=[sb.Clamped("x0"), sb.Held(edge="y0", components=("z",)), sb.Symmetric(edge="y1")],
        actuators=[moved],
        probes={"µ 1": (0.1, 0.1)},
    )
    scene.save(tmp_path / "scene.toml")
    assert sb.load(tmp_path / "scene.toml") == scene
