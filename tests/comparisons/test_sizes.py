"""Sizes predicted before anything is built: near what is measured, and a refusal where they do not fit."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from commands import run
from verbs import SMALL, write_inputs

import lumped
import sheetbench as sb
from comparisons.external import memory
from comparisons.models import sizes
from comparisons.models.spec import spec_of
from comparisons.tradeoff.statics import tradeoff
from fem_reference.footprint import footprint as of_reference
from sheetbench import scenes
from sheetbench.answers.size import factors
from sheetbench.errors import BadInput

GB = 10**9
SCENE = "two-edges-clamped"


def room(monkeypatch, amount):
    monkeypatch.setattr(memory, "available", lambda: amount)


PEAK = """
import json, sys
import sheetbench as sb
from comparisons.models.solve import warm
from comparisons.sweep.peak_memory import with_peak_memory
from sheetbench.heap import keep_freed_memory

keep_freed_memory()  # as the command line does
model, settings = sys.argv[1], json.loads(sys.argv[2])
warm(model)
print(with_peak_memory(lambda: sb.solve("two-edges-clamped", model, **settings))[1])
"""


@pytest.mark.sweep(2)
@pytest.mark.parametrize(
    ("model", "settings"), [("shell", {"elements": 20}), ("lumped", {"grid": [33, 33, 2]})]
)
def test_peaks_are_within_a_factor_of_two_of_what_is_told(model, settings):
    """In a process of its own, above what the code takes."""
    command = [sys.executable, "-c", PEAK, model, json.dumps(settings)]
    peak = int(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
    predicted = sizes.size(scenes.load(SCENE), spec_of(model, settings))
    assert predicted is not None and 0.5 < predicted.memory / peak < 2.0


def test_sizes_grow_with_every_count():
    def grows(footprint, *pair):
        one, other = (footprint(*given) for given in pair)
        return one.unknowns < other.unknowns and one.memory < other.memory and one.seconds < other.seconds

    for a, b in ((2, 3), (9, 17), (33, 65), (129, 257), (1000, 2000)):
        for small, large in (((a, 9, 2), (b, 9, 2)), ((9, a, 2), (9, b, 2)), ((9, 9, a), (9, 9, b))):
            assert grows(lumped.footprint, (small,), (large,))
        for model in ("plate", "shell", "solid"):
            assert grows(of_reference, (model, (a, 4)), (model, (b, 4)))
    assert of_reference("solid", (8, 8), 1).memory < of_reference("solid", (8, 8), 2).memory


def test_a_strip_is_banded_and_a_square_dissected():
    """Of n × m nodes with n ≪ m: proportional to m, and never more than the band of the shorter side."""
    for n in (2, 5, 33):
        nonzeros, operations = factors((n, 10_000), 3)
        assert factors((10_000, n), 3) == (nonzeros, operations)
        assert factors((n, 20_000), 3) == pytest.approx((2.0 * nonzeros, 2.0 * operations))
        assert nonzeros <= n * 10_000 * (n + 1) * 9 and operations <= n * 10_000 * (n + 1) ** 2 * 27
    assert factors((2, 100), 1)[0] == 200 * 3
    square = factors((1024, 1024), 1)
    assert square[0] == pytest.approx(31 / 4 * 1024**2 * 10) and square[1] == pytest.approx(
        829 / 84 * 1024**3
    )


def test_a_grid_of_six_gigabytes_needs_a_machine_that_has_them(monkeypatch):
    def require(grid):
        sizes.require_room(scenes.load(SCENE), spec_of("lumped", {"grid": grid}))

    room(monkeypatch, 16 * GB)
    require(257)
    room(monkeypatch, 4 * GB)
    with pytest.raises(
        BadInput, match=r"lumped 257x257x2: 396 294 unknowns take about .* GB of memory"
    ) as no:
        require(257)
    fitting = int(str(no.value).split("--lumped ")[1].split()[0])
    require(fitting)
    with pytest.raises(BadInput):
        require(fitting + 1)


def test_a_long_thin_sheet_is_refused_with_what_fits(monkeypatch):
    """4672 times as long as wide: four elements across are 75 000 in all."""
    sizes_ = {"length_x": 0.01, "length_y": 46.72, "thickness": 1e-4}
    strip = scenes.load("one-edge-clamped").replace(**sizes_, probes={"tip": (0.0, 46.72)})
    room(monkeypatch, 4 * GB)
    with pytest.raises(BadInput, match=r"shell 4x18688: .* --elements 2 would fit"):
        sb.compare(strip, grid=(3, 9), elements=4)
    room(monkeypatch, 0.3 * GB)
    with pytest.raises(BadInput, match="take fewer along the longer side, --elements NxM"):
        sb.solve(strip, "shell", elements=4)
    with pytest.raises(BadInput, match=r"shell 8x37376: .*; no coarser trial exists"):
        sb.tradeoff(strip, tolerance=0.01)


def test_every_candidate_is_looked_at_before_the_first_run(store, monkeypatch):
    room(monkeypatch, 3 * GB)
    few = {"store": store, "pool": pytest.fail}
    listed = [spec_of("lumped", {"grid": 3}), spec_of("solid", {"elements": 64})]
    with pytest.raises(BadInput, match=r"solid 64x64x1: .*--solid \d+ would fit"):
        tradeoff(scenes.load(SCENE), listed, reference=spec_of("shell", {"elements": 4}), **few)
    with pytest.raises(BadInput, match=r"shell 128x128: .*--elements \d+ would fit"):
        tradeoff(scenes.load(SCENE), [spec_of("shell", {"elements": 64})], **few)


def test_modes_take_more_than_statics_and_state_spaces_are_dense(monkeypatch):
    shell = of_reference("shell", (16, 16)).memory
    room(monkeypatch, 1.3 * shell)
    sb.solve(SCENE, "shell", elements=16)
    with pytest.raises(BadInput, match=r"shell 16x16: .* --elements 1\d would fit"):
        sb.modes(SCENE, grid=3, elements=16)
    room(monkeypatch, GB // 10)
    with pytest.raises(BadInput, match=r"3 072 states: .* 226 MB .*; --state-space 1\d{3} would fit"):
        sb.modes(SCENE, grid=17, state_space=0)


MOVED = "--duration 0.004 --lumped"
LINES = [SMALL[name] for name in ("compare", "compare motion", "identify", "modes", "simulate")]
MORE = [SMALL[name] for name in ("tradeoff", "tradeoff tolerance", "stability")]
MORE += [f"calibrate {SCENE} --grid {grid}" for grid in ("3 --calibration fit-modal", "100000 --export out")]
MORE += [f"tradeoff {SCENE} {MOVED} 3 --plate= --shell 2 --solid="]


@pytest.mark.parametrize("line", LINES + MORE)
def test_every_verb_refuses_what_does_not_fit(line, tmp_path, monkeypatch, capsys):
    """Where next to nothing is free."""
    monkeypatch.chdir(tmp_path)
    write_inputs(tmp_path)
    room(monkeypatch, 1000.0)
    assert run(*line.split()) == 2
    said = capsys.readouterr().err.splitlines()[-1]
    assert "of memory, and 0.001 MB are free here" in said and "--large" in said
    assert not Path("out").exists()


FREE = {"proc/meminfo": "MemTotal:  9000000 kB\nMemAvailable:    4000000 kB\n"}
SECOND = {
    "proc/self/cgroup": "0::/user/box\n",
    "sys/fs/cgroup/user/box/memory.max": "max\n",
    "sys/fs/cgroup/user/box/memory.current": "700000000\n",
    "sys/fs/cgroup/user/memory.max": "3000000000\n",
    "sys/fs/cgroup/user/memory.current": "2500000000\n",
    "sys/fs/cgroup/user/memory.stat": "anon 1\ninactive_file 500000000\n",
}
FIRST = {
    "proc/self/cgroup": "7:cpu,memory:/box\n3:pids:/box\n",
    "sys/fs/cgroup/memory/box/memory.limit_in_bytes": "2000000000\n",
    "sys/fs/cgroup/memory/box/memory.usage_in_bytes": "500000000\n",
    "sys/fs/cgroup/memory/memory.limit_in_bytes": "9223372036854771712\n",
    "sys/fs/cgroup/memory/memory.usage_in_bytes": "500000000\n",
}


@pytest.mark.parametrize(("files", "left"), [({}, 4096 * 10**6), (SECOND, 10**9), (FIRST, 15 * 10**8)])
def test_what_is_free_is_the_least_that_anything_leaves(files, left, tmp_path, monkeypatch):
    """The machine, and control groups with their parents; pages of files are given back."""
    files = {"proc/self/status": "VmPeak: 9 kB\nVmSize:\t  100000 kB\n"} | FREE | files
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    monkeypatch.setattr(memory, "ROOT", tmp_path)
    limits = memory.resource
    for limit, known in ((limits.RLIM_INFINITY, left), (300_000_000, 300_000_000 - 102_400_000)):
        monkeypatch.setattr(limits, "getrlimit", lambda which, limit=limit: (limit, limit))
        assert memory.available() == known
