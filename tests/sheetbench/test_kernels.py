"""Compiled kernels: kept, compiled anew with the files whose kernels they call, and guests in the process."""

import json
import shutil
import subprocess
import sys
from typing import Any, NamedTuple

import numpy as np
import pytest
import scipy.sparse as sp
from commands import python
from dynamic_cases import make_scene, springs
from numba import njit, typeof
from verbs import SMALL, write_inputs

import lumped
from comparisons.models import solve
from lumped.dynamics.explicit.steps import march
from sheetbench.kernels import NOTICE, ROOT, compiled_before
from sheetbench.numerics import sparse_products
from sheetbench.numerics.options import TypedTuple, typed
from sheetbench.numerics.sparse_products import csr_arrays

ASK = """
import logging
logging.basicConfig(level=logging.INFO, format="%(message)s")
import numpy as np
from sheetbench.numerics.sparse_products import Rows, product
product(Rows(np.array([0, 1]), np.array([0]), np.array([2.0])), np.array([3.0]))
"""


def test_matrices_are_alike_to_kernels_whatever_integers_scipy_takes():
    small = sp.csr_array(np.eye(2))
    large = sp.csr_array((small.data, small.indices.astype(np.int64), small.indptr.astype(np.int64)))
    assert small.indices.dtype != large.indices.dtype
    assert [part.dtype for part in csr_arrays(small)] == [part.dtype for part in csr_arrays(large)]


def test_steps_are_compiled_once_whether_edges_are_driven_or_not():
    """Tables whose rows have gaps are other arrays to a kernel, which takes ten seconds to compile."""
    lifted = [[0.0] * 3, [0.0, 0.0, 0.01]]
    motion = {"kind": "motion", "edge": "x1", "time": [0.0, 1.0], "displacement": lifted}
    driven = make_scene("one-edge-clamped", [motion])
    lumped.simulate(driven, springs(driven, 3), 1e-4, integrator="verlet")
    layouts = {getattr(kind, "layout", "C") for signature in march.signatures for kind in signature}
    assert layouts == {"C"}


def ask(place, cache, code=ASK):
    """What is logged, compiling included, by a process that runs a kernel from a checkout at `place`."""
    done = python("-c", code, place=place, NUMBA_CACHE_DIR=str(cache), PYTHONPATH=str(place))
    assert done.returncode == 0, done.stderr
    return done.stderr


def test_a_kernel_is_compiled_anew_where_any_file_with_kernels_changed(tmp_path):
    """It may call them: numba alone looks at the kernel's own file, and would go on with old machine code."""
    copy, cache = tmp_path / "copy", tmp_path / "cache"
    for package in ("sheetbench", "lumped"):
        shutil.copytree(ROOT / package, copy / package, ignore=shutil.ignore_patterns("__pycache__"))
    assert [ask(copy, cache), ask(copy, cache)] == [NOTICE + "\n", ""]
    with (copy / "lumped/springs/laws.py").open("a", encoding="utf-8") as file:
        file.write("# another law\n")
    assert [ask(copy, cache), ask(copy, cache)] == [NOTICE + "\n", ""]


def test_a_cache_that_cannot_be_written_is_read_and_left_as_it_is(tmp_path):
    """As an image of a container has it, or a machine without a home."""
    cache = tmp_path / "cache"
    ask(ROOT, cache)
    kept = sorted(path.name for path in cache.rglob("*"))
    closed = "import os; free = os.access; os.access = lambda at, mode: not mode & os.W_OK and free(at, mode)"
    assert NOTICE not in ask(ROOT, cache, f"{closed}\n{ASK}")
    assert sorted(path.name for path in cache.rglob("*")) == kept
    assert NOTICE in ask(ROOT, "/proc/none")


USERS = """
import sys
import numpy as np, numba as nb
from numba.core import config, event
from numba.extending import overload, register_jitable

def show(name, call, *given):
    try:
        print(name, call(*given), flush=True)
    except Exception as error:
        print(name, type(error).__name__, error, flush=True)

@nb.njit
def before(a):
    return np.cumsum(a).sum() + np.zeros(3).sum()

@nb.njit(cache=True)
def area(x):
    return x * x

if sys.argv[1] != "without":
    if sys.argv[1] == "after":
        show("before", before, np.ones(3)), show("area", area, 3.0)
    import sheetbench.kernels
    from sheetbench.numerics.sparse_products import Rows, product
    product(Rows(np.array([0, 1]), np.array([0]), np.array([2.0])), np.array([3.0]))
if sys.argv[1] != "after":
    show("before", before, np.ones(3)), show("area", area, 3.0)

show("another type", before, np.ones(3, np.float32)), show("another type", area, 3)
show("calls an old one", nb.njit(lambda x, h: area(x) * h), 3.0, 2.0)
show("sorts anew", nb.njit(lambda a: np.sort(a).sum()), np.ones(3))

def overloaded(x): ...

@overload(overloaded)
def _(x):
    def implementation(x):
        print("printed", x)
        if x > 1.0:
            raise ValueError("big", x)
        return x
    return implementation

@register_jitable
def in_python(x):
    with nb.objmode(y="f8"):
        y = float(repr(x))
    return y

@nb.njit(no_cpython_wrapper=True)
def unwrapped(x):
    print("printed", x)
    return x

@nb.njit
def assigned(a, b):
    a[:] = b

@nb.experimental.jitclass([("x", nb.f8)])
class Boxed:
    def __init__(self, x):
        self.x = x

@nb.vectorize(["f8(f8, f8)"])
def added(x, y):
    return x + y

show("class", lambda: Boxed(3.0).x), show("ufunc", added, 1.0, 2.0)
show("overload", nb.njit(lambda x: overloaded(x)), 1.0)
show("overload that raises", nb.njit(lambda x: overloaded(x)), 2.0)
show("jitable", nb.njit(lambda x: in_python(x)), 2.0)
show("unwrapped", nb.njit(lambda x: unwrapped(x)), 2.0)
show("shapes", assigned, np.zeros(3), np.zeros(4))
with event.install_recorder("numba:llvm_lock") as recorder:
    nb.njit(lambda x: x + 1)(1)
print(len(recorder.buffer) > 0, config.CPU_NAME, config.CPU_FEATURES, config.CACHE_DIR)
print(area.stats.cache_path)
"""


@pytest.mark.nightly  # three processes that compile for six seconds each
def test_functions_of_the_user_are_as_without_this_project(tmp_path):
    """Compiled before it or after, from an empty cache: answers, error texts, events, settings, cache."""
    (tmp_path / "users.py").write_text(USERS)

    def said(when):
        done = python(
            str(tmp_path / "users.py"), when, NUMBA_CACHE_DIR=str(tmp_path / when), PYTHONPATH=str(ROOT)
        )
        assert done.returncode == 0, done.stderr
        return done.stdout.replace(str(tmp_path / when), "")

    without = said("without")
    assert "cannot assign slice of shape (3,) from input of shape (4,)" in without
    assert "overload that raises ValueError ('big', 2.0)" in without
    assert said("first") == without
    assert sorted(said("after").splitlines()) == sorted(without.splitlines())


COMPILED = """
import contextlib, io, json, sys
from numba.core import event
from comparisons.cli.app import main

with event.install_recorder("numba:compile") as recorder:
    for line in json.loads(sys.argv[1]):
        with contextlib.redirect_stdout(io.StringIO()), contextlib.suppress(SystemExit):
            main(line.split())
compiled = {e.data["dispatcher"].py_func.__qualname__ for _, e in recorder.buffer}
print(json.dumps(sorted(compiled)))
"""


@pytest.mark.parametrize(
    "verbs", [("compare", "simulate", "modes"), pytest.param(tuple(SMALL), marks=pytest.mark.nightly)]
)
def test_a_second_run_compiles_nothing(verbs, tmp_path):
    write_inputs(tmp_path)
    lines = json.dumps([f"{SMALL[verb]} --no-pictures" for verb in verbs])
    runs = [python("-c", COMPILED, lines, place=tmp_path, PYTHONPATH=str(ROOT)) for _ in range(2)]
    assert runs[-1].returncode == 0, runs[-1].stderr
    assert json.loads(runs[-1].stdout.splitlines()[-1]) == []


STATE = """
import gc, logging, os, signal, sys, threading, warnings
import multiprocessing
import matplotlib
import numpy as np
import pyvista
from threadpoolctl import threadpool_info

def state():
    return {
        "environment": dict(os.environ),
        "garbage": (gc.isenabled(), gc.get_threshold(), gc.get_freeze_count(), len(gc.callbacks)),
        "warnings": list(warnings.filters),
        "logging": (logging.root.level, list(logging.root.handlers), logging.raiseExceptions),
        "numpy": (np.geterr(), np.geterrcall(), np.get_printoptions()),
        "blas": sorted((each["filepath"], each["num_threads"]) for each in threadpool_info()),
        "signals": {number: signal.getsignal(number) for number in signal.valid_signals()},
        "start": multiprocessing.get_start_method(allow_none=True),
        "hooks": (sys.excepthook, threading.excepthook, sys.displayhook, sys.getrecursionlimit()),
        "matplotlib": (dict(matplotlib.rcParams), matplotlib.get_backend(auto_select=False)),
        "pyvista": (pyvista.global_theme.to_dict(), pyvista.OFF_SCREEN),
    }

import scipy.linalg, numba, skfem, shapely, pydantic, meshio, rich  # what they set is theirs

before = state()
import sheetbench as sb

def check(when):
    now = state()
    for name, value in before.items():
        assert now[name] == value, (when, name, value, now[name])

check("import")
sb.solve("one-edge-clamped", grid=3)
check("solve")
answer = sb.compare("one-edge-clamped", grid=3, elements=2)
check("compare")
answer.report()
answer.save("out")
check("figures")
sb.simulate("one-edge-clamped", 1e-3, grid=3)
check("simulate")
"""


def test_a_process_is_left_as_it_was(tmp_path):
    done = python("-c", STATE, place=tmp_path, PYTHONPATH=str(ROOT))
    assert done.returncode == 0, done.stderr


class Inner(NamedTuple):
    values: np.ndarray
    number: int


class Other(NamedTuple):
    values: np.ndarray
    number: int


class Outer(NamedTuple):
    inner: Inner | Other
    at: np.ndarray


def test_a_compiled_function_takes_a_typed_tuple_as_the_named_one():
    """Tuples of two classes with the same arrays, typed before or not, are told apart."""

    @njit
    def total(outer):
        return outer.inner.values[outer.at[0]] + outer.inner.number

    values, at = np.array([1.0, 2.0]), np.array([1])
    for kind in (Inner, Other):
        plain = Outer(kind(values, 3), at)
        within = Outer(typed(kind(values, 3)), at)
        for given in (plain, typed(plain), within, typed(within)):
            assert total(given) == 5.0
            assert typeof(given) == typeof(plain)
        assert isinstance(typed(plain), TypedTuple)
    assert len(total.signatures) == 2


UNCOMPILED = """
import json

import fem_reference, lumped
import sheetbench as sb


def numbers():
    clamped = sb.load("two-edges-clamped")
    settling = sb.load("two-edges-settling")
    rubber = clamped.replace(material=clamped.material.replace(law="neo-hookean"))
    at = [[0.1, 0.15]]
    springs, elastic = (lumped.calibrate(clamped.sheet, one.material, 3) for one in (clamped, rubber))
    return {
        "lattice": lumped.solve(clamped, springs).displacement(at).tolist(),
        "rubber lattice": lumped.solve(rubber, elastic).displacement(at).tolist(),
        "shell": fem_reference.solve(clamped, elements=1).displacement(at).tolist(),
        "lattice's modes": [lumped.modes(clamped, springs, 2).frequencies.tolist()],
        "shell's modes": [fem_reference.modes(clamped, elements=1, count=2).frequencies.tolist()],
        "esdirk": lumped.simulate(settling, springs, 4e-3).probes["P4"].tolist(),
        "verlet": lumped.simulate(settling, springs, 5e-4, integrator="verlet").probes["P4"].tolist(),
    }
"""


@pytest.mark.nightly  # half a minute of Python
def test_uncompiled_kernels_give_equal_numbers():
    ran = python("-c", f"{UNCOMPILED}\nprint(json.dumps(numbers()))", NUMBA_DISABLE_JIT="1")
    assert ran.returncode == 0, ran.stderr[-2000:]
    here: dict[str, Any] = {}
    exec(UNCOMPILED, here)
    for name, found in here["numbers"]().items():
        flat, same = ([x for row in rows for x in row] for rows in (found, json.loads(ran.stdout)[name]))
        assert same == pytest.approx(flat, rel=1e-6, abs=1e-9 * max(map(abs, flat))), name


def test_what_two_models_need_is_compiled_side_by_side_where_none_is_compiled_before(monkeypatch):
    started = []

    def beside(command, **options):
        started.append(command[-1])
        return subprocess.Popen([sys.executable, "-c", ""], **options)

    monkeypatch.setattr(solve, "Popen", beside)
    solve.warm_both("lumped", "shell")
    assert [code.split("; ")[-1] for code in started] == ["warm('shell')"]
    sparse_products.product(
        sparse_products.Rows(np.array([0, 1]), np.array([0]), np.array([2.0])), np.array([3.0])
    )
    assert compiled_before(sparse_products.__file__)
    assert not compiled_before(__file__)
