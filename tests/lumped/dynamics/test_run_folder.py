"""The folder of a run in time: resuming after a kill, damage, one writer, a full disk, memory."""

import contextlib
import json
import os
import shutil
import tracemalloc
from functools import partial

import numpy as np
import pytest
from dynamic_cases import make_scene, springs
from limits import at_most

import fem_reference
import lumped
from lumped.dynamics import INTEGRATORS
from sheetbench.answers.solution import Status
from sheetbench.files import only_writer
from sheetbench.runs.store import FolderStore
from sheetbench.scenes import Air, BadInput, Plane, Relaxation, load

PULSE = {"kind": "pressure", "value": 5.0, "history": {"time": [0.0, 0.01, 0.02], "factor": [0.0, 1.0, 0.0]}}
CHAIN = {"segments": 2, "curvature": 3.0}
MOVED = {"time": [0.0, 0.004, 0.013, 0.02], "displacement": [[0.0, 0.0, z] for z in (0.0, 1e-3, 3e-3, 3e-3)]}
BENT = {"time": (0.0, 0.013, 0.05), "factor": (0.0, 1.0, 0.5)}
SETTLING = load("two-edges-settling")


def moved(*chains, loads=(PULSE,)):
    """A sheet whose clamp moves."""
    clamp = {"edge": "x0", "kind": "clamped", "motion": MOVED}
    return make_scene("one-edge-clamped", chains, loads=loads, damping_time=1e-3, supports=[clamp])


def relaxing(*chains, loads=(PULSE,)):
    """A sheet with a Maxwell branch in air."""
    scene = make_scene("one-edge-clamped", chains, loads=loads, damping_time=1e-3)
    return scene.replace(relaxation=(Relaxation(0.3, 0.02),), air=Air(drag=1.2))


# falls 1 mm by 14 ms, and touches before and after the checkpoint
FALLING = make_scene("one-edge-clamped").replace(obstacles=(Plane(position=(0.0, 0.0, -0.002)),))
# a bend of a load's history before the checkpoint and one after
BENDING = SETTLING.replace(gravity=SETTLING.gravity.replace(history=BENT), air=Air(drag=1.2))
RUNS = [  # scene, duration with two checkpoints [s], integrator of the lattice or step of the shell
    *((of(), 0.025, name) for name in INTEGRATORS for of in (moved, relaxing)),
    *((of(CHAIN, loads=loads), 0.025, "midpoint") for loads in ((), (PULSE,)) for of in (moved, relaxing)),
    *((FALLING, 0.06, name) for name in ("esdirk", "verlet")),
    *((BENDING, 0.07, step) for step in (None, 1e-3)),
]


@pytest.mark.sweep(5)
@pytest.mark.parametrize(("scene", "duration", "how"), RUNS)
def test_a_killed_run_resumes_to_the_last_digit(tmp_path, scene, duration, how):
    """From a copy of its folder at a moment between two samples, which is what kill -9 leaves there. In one
    process: kernels that it compiles itself and those of the cache may differ in the last digits."""
    whole, killed, after = tmp_path / "whole", tmp_path / "killed", []

    def kill(time):
        after.extend([time] if (whole / "checkpoint.npz").exists() else [])
        if len(after) == 2:  # samples after the checkpoint, to be dropped
            shutil.copytree(whole, killed)

    def run(folder, progress=None, duration=duration):
        options = {"store": folder, "every": duration / 100, "frames": 20, "progress": progress}
        if scene is BENDING:
            return fem_reference.simulate(scene, "shell", duration, elements=2, step=how, **options)
        return lumped.simulate(scene, springs(scene, 4), duration, integrator=how, **options)

    run(tmp_path / "compiled", duration=2e-3)
    at_once = run(whole, kill)
    killed_at = (killed / "samples.bin").stat().st_size
    resumed = run(killed)
    for file in ("samples.bin", "frames.bin"):
        assert (killed / file).read_bytes() == (whole / file).read_bytes()
    assert killed_at < (whole / "samples.bin").stat().st_size
    assert resumed.status is at_once.status is Status.CONVERGED and resumed.steps == at_once.steps
    assert 0.0 < resumed.resumed_from < duration and at_once.resumed_from == 0.0
    if scene is BENDING:
        with pytest.raises(BadInput, match="another run"):
            fem_reference.simulate(scene, "plate", duration, elements=2, store=killed)


LENGTH = 0.011  # s, one checkpoint


def run_in(folder, duration=LENGTH, **other):
    """A small run that is kept in a folder."""
    scene = make_scene(damping_time=1e-3)
    options = {"integrator": "verlet", "every": 2e-4, "frames": 5, **other}
    return lumped.simulate(scene, springs(scene, 3), duration, store=folder, **options)


@pytest.fixture(scope="module")
def run_kept(tmp_path_factory):
    folder = tmp_path_factory.mktemp("kept") / "run"
    return folder, run_in(folder)


@pytest.fixture
def kept(run_kept, tmp_path):
    """A folder with a finished run, and how to run it again."""
    folder, history = tmp_path / "run", run_kept[1]
    shutil.copytree(run_kept[0], folder)
    return folder, history, partial(run_in, folder)


def test_another_run_in_the_folder_is_refused_by_what_differs(kept):
    folder, _, again = kept
    before = (folder / "run.json").read_bytes()
    with pytest.raises(BadInput, match=r"holds another run \(of another every, step\)"):
        again(step=1e-5, every=1e-4)
    with pytest.raises(BadInput, match=r"holds another run \(of another duration\)"):
        again(2.0 * LENGTH)
    assert (folder / "run.json").read_bytes() == before


def half(content):
    return content[: len(content) // 2 - 3]


def flipped(content):
    at = len(content) // 3
    return content[:at] + bytes([content[at] ^ 1]) + content[at + 1 :]


SHORT, CHANGED = "holds .* that the checkpoint counts", "was changed after the run wrote it: .*"
DAMAGE = [  # file, what is made of its content (None: removed), what is said
    *((name, change, SHORT) for name in ("samples.bin", "frames.bin") for change in (b"", half, None)),
    *((name, flipped, CHANGED) for name in ("samples.bin", "frames.bin")),
    *(("run.json", text, "is damaged") for text in (b"", b"{}", b"[1]", b"\xff\xfe")),
    ("run.json", None, "is missing beside a checkpoint"),
    *(("checkpoint.npz", change, "is damaged") for change in (b"not a checkpoint", b"", half)),
]


@pytest.mark.parametrize(("name", "change", "said"), DAMAGE)
def test_damaged_files_are_refused_in_a_line_with_the_remedy_and_left_alone(kept, name, change, said):
    """Short ones were filled up with zeros, changed ones went unnoticed into the history."""
    folder, _, again = kept
    path = folder / name
    if change is None:
        path.unlink()
    else:
        path.write_bytes(change(path.read_bytes()) if callable(change) else change)
    before = {file.name: file.read_bytes() for file in folder.iterdir()}
    with pytest.raises(BadInput, match=rf"{name}: {said}.*; remove the folder {folder}"):
        again()
    assert {file.name: file.read_bytes() for file in folder.iterdir()} == before


@pytest.mark.parametrize("key", ["version", "source"])
def test_a_run_that_other_code_began_is_not_gone_on_with(kept, key):
    folder, _, again = kept
    run = json.loads((folder / "run.json").read_text())
    run["asked"][key] = "another"
    (folder / "run.json").write_text(json.dumps(run))
    with pytest.raises(BadInput, match="a run of other code of sheetbench"):
        again()


def test_a_checkpoint_is_on_the_disk_after_what_it_counts_and_before_it_has_its_name(tmp_path, monkeypatch):
    """Whole, each of them: a machine that stops at any moment leaves nothing counted that is not there."""
    synced = []

    def fsync(file):
        about = os.fstat(file)
        synced.append((about.st_ino, about.st_size, (tmp_path / "checkpoint.npz").exists()))

    monkeypatch.setattr(os, "fsync", fsync)
    with FolderStore(tmp_path, {"samples": (2,), "frames": (3, 3)}, {}) as store:
        store.resume()
        assert store.rows("samples").shape == (0, 2) and store.rows("frames").shape == (0, 3, 3)
        store.append("samples", np.ones((1, 2)))
        store.append("frames", np.ones((1, 3, 3)))
        store.checkpoint({"step": np.array(1)})
    files = [(tmp_path / name).stat() for name in ("samples.bin", "frames.bin", "checkpoint.npz")]
    assert synced == [(about.st_ino, about.st_size, False) for about in files]


def test_a_run_has_one_writer(kept):
    """Two at once left rows of both in one file, which no command could read again."""
    folder, history, again = kept
    with (
        only_writer(folder),
        pytest.raises(BadInput, match=f"{folder}: another process writes here; wait until it has ended"),
    ):
        again()
    assert np.array_equal(again().probes["P4"], history.probes["P4"])


@pytest.mark.parametrize("name", ["run.json", "samples.bin", "frames.bin", "checkpoint.npz", ".lock"])
def test_a_planted_link_is_never_written_through(tmp_path, name):
    victim, folder = tmp_path / "victim", tmp_path / "run"
    victim.write_text("mine")
    folder.mkdir()
    (folder / name).symlink_to(victim)
    with contextlib.suppress(BadInput):
        run_in(folder)
    assert victim.read_text() == "mine"


def test_a_full_disk_is_said_and_the_run_goes_on_when_there_is_room(tmp_path, run_kept):
    """A limit on file sizes stands for the disk: frames.bin fits, then samples.bin is full, at any place."""
    folder, history = tmp_path / "run", run_kept[1]
    full = (run_kept[0] / "samples.bin").stat().st_size
    for most in (10, full // 2, full - 10):
        with at_most(most), pytest.raises(BadInput, match=r"run\S*: cannot be written, file too large: "):
            run_in(folder)
    assert np.array_equal(run_in(folder).probes["P4"], history.probes["P4"])


@pytest.mark.nightly
def test_memory_does_not_grow_with_the_duration(tmp_path):

    def peak(duration):
        tracemalloc.start()
        options = {"integrator": "midpoint", "step": 1e-3, "every": 1e-3, "frames": 0}
        run_in(tmp_path / str(duration), duration, **options)
        found = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return found

    peak(0.05)
    # bytes; 700 more samples are 185 kB. Python 3.13 holds some 40 kB more after 700 steps, in freed small
    # objects whose number levels off: half of what samples would take distinguishes the two
    assert peak(0.8) < peak(0.1) + 90_000
    assert (tmp_path / "0.8" / "samples.bin").stat().st_size > 150_000
