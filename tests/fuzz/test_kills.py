"""`make kills SEED=2`: campaigns, runs and trade-offs, killed at drawn instants and resumed to their end.

What had been kept by a kill stands unchanged ever after; the end is what an undisturbed process leaves.
"""

import json
import os
import random
import signal
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from campaigns import Serial, rows_in, task
from dynamic_cases import make_scene, springs

import fem_reference
import lumped
from comparisons.sweep.campaign import campaign, carry_out
from comparisons.sweep.store import FILE
from sheetbench.files import LOCK
from sheetbench.scenes import Scene, load

TREE = Path(__file__).resolve().parents[2]
SEED = os.environ.get("FUZZ", "")
pytestmark = pytest.mark.skipif(not SEED, reason="make kills")
Kept = dict[str, Any]  # what a folder holds and must go on holding, by name
TRADEOFF = (
    *("tradeoff", "two-edges-clamped", "--lumped", "3,4,5", "--calibration", "uniform"),
    *("--plate", "2", "--shell", "2", "--solid", "", "--elements", "4", "--repeats", "1", "--workers", "1"),
)
TIMED = ("seconds", "memory", "samples", "load_average")  # parts of the names of what no two runs have alike


def run_campaign(folder: Path) -> None:
    """Forty runs with long rows, in this process."""
    with campaign(folder) as store:
        carry_out([task("ballast", x=x, size=50_000) for x in range(40)], store, pool=Serial)


def run_in_time(folder: Path, scene: Scene, grid: int, duration: float, **how: Any) -> None:
    """A motion with samples, frames and some checkpoints."""
    lumped.simulate(scene, springs(scene, grid), duration, store=folder, frames=20, **how)


def run_of_reference(folder: Path) -> None:
    """A motion of the shell, its steps by the error, with checkpoints within them."""
    fem_reference.simulate(
        "two-edges-settling", "shell", 0.04, elements=2, store=folder, every=2e-4, frames=20
    )


def run_tradeoff(folder: Path) -> None:
    """The command itself, with a worker process."""
    os.execv(sys.executable, [sys.executable, "-m", "sheetbench", *TRADEOFF, "--out", str(folder)])


def rows(folder: Path) -> Kept:
    """A campaign's rows as they stand, time stamps and all."""
    return dict(rows_in(folder / FILE))


def checkpointed(folder: Path) -> Kept:
    """The bytes of a run's samples that its checkpoint counts, a thousand at a time."""
    if not (folder / "checkpoint.npz").exists():
        return {}
    with np.load(folder / "checkpoint.npz") as checkpoint:
        size = int(checkpoint["samples"])
    content = (folder / "samples.bin").read_bytes()[:size]
    return {str(at): content[at : at + 1000] for at in range(0, size - 999, 1000)}


def answers(folder: Path) -> Kept:
    """A campaign's rows without what no two runs have alike."""
    found = {}
    for key, (_, name, question, status, row, message, *_) in rows_in(folder / FILE).items():
        found[key] = (name, question, status, timeless(json.loads(row)), message)
    return found


def timeless(data: Any) -> Any:
    """A document without times and memory."""
    if isinstance(data, dict):
        return {key: timeless(value) for key, value in data.items() if not any(part in key for part in TIMED)}
    return [timeless(value) for value in data] if isinstance(data, list) else data


def contents(folder: Path) -> Kept:
    """The files of a run to the last bit."""
    return {name: (folder / name).read_bytes() for name in ("samples.bin", "frames.bin")}


@dataclass(frozen=True)
class Kind:
    """What is run in a folder, what must not change there once it is kept, how it looks at the end, and how
    many kills there are."""

    run: Callable[[Path], None]
    kept: Callable[[Path], Kept]
    end: Callable[[Path], Kept]
    kills: int


SWINGING = make_scene("one-edge-clamped", damping_time=1e-3)
KINDS = {
    "campaign": Kind(run_campaign, rows, answers, 45),
    "run": Kind(
        partial(run_in_time, scene=SWINGING, grid=4, duration=0.06, every=2e-4, integrator="verlet"),
        checkpointed, contents, 30,
    ),
    "reference": Kind(run_of_reference, checkpointed, contents, 15),
    "muscles": Kind(  # from the equilibrium in which it hangs
        partial(run_in_time, scene=load("muscle-bands"), grid=5, duration=0.3, every=2e-3),
        checkpointed, contents, 15,
    ),
    "contact": Kind(  # a strip that falls on a table
        partial(run_in_time, scene=load("strip-on-table"), grid=5, duration=0.15, every=5e-4),
        checkpointed, contents, 15,
    ),
    "tradeoff": Kind(run_tradeoff, rows, answers, 15),
}  # fmt: skip


def started(run: Callable[[Path], None], folder: Path) -> int:
    """A process of its own that runs in a folder, silently."""
    process = os.fork()
    if process:
        return process
    try:
        with Path(os.devnull).open("w") as nowhere:
            os.dup2(nowhere.fileno(), 1)
            os.dup2(nowhere.fileno(), 2)
        os.chdir(TREE)
        run(folder)
    except BaseException:
        os._exit(1)
    os._exit(0)


def ended(process: int) -> int:
    """Its exit status, negative the signal that killed it."""
    return os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])


def killed(process: int, seconds: float) -> int:
    """The exit status of a process that is killed after so many seconds, if it still runs."""
    time.sleep(seconds)
    os.kill(process, signal.SIGKILL)  # of a child not waited for: it is nobody else
    return ended(process)


def names(folder: Path) -> set[str]:
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.name != LOCK}


def undisturbed(kind: Kind, place: Path) -> tuple[Kept, set[str], float]:
    """What a process leaves that nobody kills, and how long it takes once all kernels are compiled."""
    for number in range(2):
        folder, clock = place / f"undisturbed-{number}", time.perf_counter()
        folder.mkdir()
        status = ended(started(kind.run, folder))
        assert status == 0, f"undisturbed it ends with {status}"
        seconds = time.perf_counter() - clock
    return kind.end(folder), names(folder), seconds


def chain(kind: Kind, folder: Path, whole: tuple[Kept, set[str], float], instants: random.Random) -> int:
    """Processes in a folder, killed until one ends; how many were. AssertionError where anything is amiss."""
    folder.mkdir()
    kept: Kept = {}
    for kills in count():
        status = killed(started(kind.run, folder), instants.uniform(0.0, 1.2) * whole[2])
        now = kind.kept(folder)
        lost = [key for key, value in kept.items() if now.get(key) != value]
        assert not lost, f"lost or changed after {kills} kills: {lost}"
        kept = now
        if status != -signal.SIGKILL:
            break
    assert status == 0, f"after {kills} kills it ends with {status}"
    found = kind.end(folder)
    differing = [key for key in found.keys() | whole[0].keys() if found.get(key) != whole[0].get(key)]
    assert not differing, f"after {kills} kills other than undisturbed: {differing}"
    left = names(folder) ^ whole[1]
    assert not left, f"after {kills} kills other files than undisturbed: {left}"
    return kills


@pytest.mark.parametrize("name", KINDS)
def test_nothing_is_lost_by_a_kill(tmp_path, name):
    kind, kills = KINDS[name], 0
    whole = undisturbed(kind, tmp_path)
    for number in count():
        if kills >= kind.kills:
            break
        kills += chain(kind, tmp_path / str(number), whole, random.Random(f"{SEED} {name} {number}"))
