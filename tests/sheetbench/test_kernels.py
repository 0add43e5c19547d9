"""Compiled kernels: kept, compiled anew with what they are made of, and announced."""

import gc
import json
import os
import platform
import shutil
import stat
import subprocess
import sys
from typing import Any, NamedTuple

import numpy as np
import pytest
import scipy.sparse as sp
from commands import python
from dynamic_cases import make_scene, springs
from llvmlite.binding import get_host_cpu_features
from numba import njit, typeof, types
from numba.core.datamodel import default_manager
from numba.core.errors import TypingError

import lumped
from comparisons.models import solve
from lumped.dynamics.explicit.steps import march
from sheetbench.kernels import NOTICE, ROOT, X86_64_V3, Locator, kept, made_of
from sheetbench.numerics import maps
from sheetbench.numerics.maps import csr_arrays
from sheetbench.numerics.typed import TypedTuple, typed

ASK = """
import logging, sys
logging.basicConfig(level=logging.INFO, format="%(message)s")
import numpy as np
import sheetbench.numerics.threads
from sheetbench.numerics.maps import Rows, product
product(Rows(np.array([0, 1]), np.array([0]), np.array([2.0])), np.array([3.0]))
"""


def test_a_kernel_is_made_of_the_files_whose_kernels_it_calls():
    found = {str(path.relative_to(ROOT)) for path in made_of(ROOT / "lumped/springs/all_families.py")}
    assert {"lumped/springs/cells.py", "lumped/springs/links.py", "lumped/springs/laws.py"} <= found
    tuples = {path.name for path in made_of(ROOT / "lumped/springs/all_forces.py")}
    assert {"packing.py", "tiles.py", "cell_laws.py"} <= tuples  # a tuple's fields count too
    assert "assembly.py" not in {
        path.name for path in made_of(ROOT / "lumped/dynamics/implicit/compiled_newton.py")
    }


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


def ask(place, cache):
    """What is said, compiling included, by a process that runs a kernel from a checkout at `place`."""
    done = python("-c", ASK, place=place, NUMBA_CACHE_DIR=str(cache), PYTHONPATH=str(place))
    assert done.returncode == 0
    return done.stderr


@pytest.mark.sweep(2)
@pytest.mark.parametrize("at", ["the cache", "a kernel's folder"])
def test_a_folder_that_others_may_write_to_is_refused(tmp_path, at):
    """What lies there is unpickled: somebody else's was executed."""
    cache = tmp_path / "cache"
    cache.mkdir(mode=0o755)
    opened = cache if at == "the cache" else cache / Locator.get_suitable_cache_subpath(maps.__file__)
    opened.mkdir(exist_ok=True)
    opened.chmod(0o775)
    small = ("compare", "one-edge-clamped", "--lumped", "3")
    done = python("-m", "sheetbench", *small, NUMBA_CACHE_DIR=str(cache))
    said = f"{opened}: other users may write here, and what is kept here is run: remove the folder"
    assert (done.returncode, done.stdout) == (2, "")
    assert said in done.stderr and "Traceback" not in done.stderr
    assert not [path for path in cache.rglob("*") if path.is_file()]


@pytest.mark.nightly
def test_a_copy_of_the_checkout_finds_what_the_checkout_compiled_and_what_came_with_it(tmp_path):
    unneeded = shutil.ignore_patterns("__pycache__")
    copy, cache, empty = tmp_path / "copy", tmp_path / "cache", tmp_path / "empty"
    for package in ("sheetbench", "lumped"):
        shutil.copytree(ROOT / package, copy / package, ignore=unneeded)
    assert [ask(ROOT, cache), ask(copy, cache)] == [NOTICE + "\n", ""]
    shutil.copytree(cache, copy / "sheetbench" / "compiled")
    assert ask(copy, empty) == "" and not list(empty.rglob("*.nbi"))


LINKED = """
from numba import njit

@njit
def twice(rows, x):
    return 2.0 * product(rows, x)

print(sum(product.stats.cache_hits.values()))
print(twice(Rows(np.array([0, 1]), np.array([0]), np.array([2.0])), np.array([3.0])))
"""


CALLED = """
import numpy as np
from sheetbench.numerics.banded import factor, solve_unrefined
from numba import njit

@njit
def factored(band, order, b):
    factor(band, len(b), 1)
    return solve_unrefined(band, 1, order, b)

band = np.zeros((8, 16))
band[:6, 0] = 4.0
x = factored(band, np.arange(6), np.ones(6))
print(sum(factor.stats.cache_hits.values()))
print(x[:1])
"""


@pytest.mark.parametrize(
    ("code", "found"), [(ASK + LINKED, "[12.]"), (CALLED, "[0.25]")], ids=["short", "long"]
)
def test_a_kernel_of_the_cache_serves_one_that_is_compiled(tmp_path, code, found):
    """What is short is linked, its LLVM code read only then; what is long is called."""
    said = [python("-c", code, NUMBA_CACHE_DIR=str(tmp_path / "cache")).stdout for _ in range(2)]
    assert said == [f"0\n{found}\n", f"1\n{found}\n"]


def test_functions_of_others_are_kept_apart_from_those_that_numba_alone_keeps(tmp_path):
    """Which one program may load after the other, with numba's settings of the user."""
    code = "from numba import njit\n\n@njit(cache=True)\ndef twice(x):\n    return 2.0 * x\n"
    (tmp_path / "others.py").write_text(code)
    cache = {"NUMBA_CACHE_DIR": str(tmp_path / "cache"), "NUMBA_CPU_NAME": "generic"}
    for first in ("", "import sheetbench.kernels; ") * 2:
        call = f"{first}from others import twice; print(twice(3.0))"
        assert (
            python("-c", call, PYTHONPATH=os.pathsep.join([str(tmp_path), str(ROOT)]), **cache).stdout
            == "6.0\n"
        )


GONE = """
import collections, sheetbench.numerics.maps as maps
maps.Gone = collections.namedtuple("Gone", maps.Rows._fields)
maps.Gone.__module__ = maps.__name__
"""


def test_what_is_kept_for_arguments_that_are_gone_is_compiled_anew(tmp_path):
    """Of a tuple whose class was removed from another file than the kernel's."""
    before = GONE + ASK.replace("product(Rows(", "product(maps.Gone(")
    kept_then = python("-c", before, NUMBA_CACHE_DIR=str(tmp_path / "cache")).stderr
    assert [kept_then, ask(ROOT, tmp_path / "cache")] == [NOTICE + "\n"] * 2


ALONE = """
import fcntl, os
from numba.core import caching

kept = caching.IndexDataCacheFile.save

def save(self, key, data):
    with open(os.path.join(self._cache_path, "lock"), "w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            print("another could write")
        except BlockingIOError:
            print("alone")
    kept(self, key, data)

caching.IndexDataCacheFile.save = save
"""


def test_a_kernel_is_kept_by_one_process_at_a_time_in_folders_of_its_user_alone(tmp_path):
    """Else a process would load what another compiled for other arguments, and crash."""
    said = python("-c", f"import os\nos.umask(0)\n{ALONE}{ASK}", NUMBA_CACHE_DIR=str(tmp_path / "cache"))
    assert said.returncode == 0 and set(said.stdout.split("\n")) == {"alone", ""}
    made = [tmp_path / "cache", *(tmp_path / "cache").iterdir()]
    assert len(made) > 1 and {stat.S_IMODE(path.stat().st_mode) for path in made} == {0o700}


def test_the_processor_is_the_common_one_unless_numba_is_there_before():
    show = "import os; print(os.environ.get('NUMBA_CPU_NAME'))"
    unset = dict.fromkeys(name for name in os.environ if name.startswith("NUMBA_CPU"))

    def printed(*lines):
        return python("-c", "\n".join([*lines, show]), place=ROOT, **unset).stdout

    common = all(map(get_host_cpu_features().get, X86_64_V3)) and platform.machine() == "x86_64"
    assert printed("import sheetbench.kernels") == f"{'x86-64-v3' if common else None}\n"
    assert printed("import numba", "import sheetbench.kernels") == "None\n"


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


def test_compiling_collects_garbage_again_afterwards_and_counts_an_arrays_memory_alone():
    @njit
    def wrong(a):
        return a.nothing

    with pytest.raises(TypingError):
        wrong(np.zeros(2))
    assert gc.isenabled()
    ((kind, _),) = default_manager.lookup(typeof(np.zeros((2, 2, 2, 2)))).traverse(None)
    assert isinstance(kind, types.MemInfoPointer)

    @njit
    def passed(pair):
        first, second = pair
        return first, (second, first + second)

    pair = np.zeros(2), np.ones(2)
    before = [sys.getrefcount(each) for each in pair]
    for _ in range(3):
        passed(pair)
    assert [sys.getrefcount(each) for each in pair] == before


@pytest.mark.nightly  # half a minute of Python
def test_they_give_what_compiled_ones_do():
    ran = python("-c", f"{UNCOMPILED}\nprint(json.dumps(numbers()))", NUMBA_DISABLE_JIT="1")
    assert ran.returncode == 0, ran.stderr[-2000:]
    here: dict[str, Any] = {}
    exec(UNCOMPILED, here)
    for name, found in here["numbers"]().items():
        flat, same = ([x for row in rows for x in row] for rows in (found, json.loads(ran.stdout)[name]))
        assert same == pytest.approx(flat, rel=1e-6, abs=1e-9 * max(map(abs, flat))), name


def test_what_two_models_need_is_compiled_side_by_side_where_none_is_kept(monkeypatch, tmp_path):
    started = []

    def beside(command, **options):
        started.append(command[-1])
        return subprocess.Popen([sys.executable, "-c", ""], **options)

    monkeypatch.setattr(solve, "Popen", beside)
    solve.warm_both("lumped", "shell")
    assert [code.split("; ")[-1] for code in started] == ["warm('shell')"]
    maps.product(maps.Rows(np.array([0, 1]), np.array([0]), np.array([2.0])), np.array([3.0]))
    assert kept(maps.__file__)
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    assert not kept(maps.__file__)
