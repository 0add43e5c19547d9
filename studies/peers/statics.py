"""Habibi et al.'s sheet at rest: lattice, shell and solid beside CalculiX, Kratos, FElupe and MuJoCo.

Error: the largest component of u − u_ref over the probes, of the largest of u_ref, a shell of `TRUTH`
elements along a side. Time: the solve alone, as every code tells it, warm; CalculiX, which is a program, with
its start and its reading and writing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

from comparisons.comparison.comparison import error
from comparisons.external.installed import known_codes
from comparisons.models.resolve import OURS, resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Elements, Spec, spec_of
from sheetbench.errors import BadInput
from sheetbench.scenes import Solution, load
from studies.peers.row import PeerRow, repeated

SCENE, TRUTH, OBLIQUE = "two-edges-clamped", 32, "consistent-oblique"


class Ladder(NamedTuple):
    """A model by size: the setting that refines it, its values; calibration: of a lattice."""

    model: str
    code: str
    setting: str
    sizes: tuple[int, ...]
    calibration: str | None = None


LADDERS = (
    Ladder("lumped", "lattice", "grid", (3, 5, 9, 17, 33)),
    Ladder("lumped", f"lattice, {OBLIQUE}", "grid", (5, 9, 17), OBLIQUE),
    Ladder("shell", "shell", "elements", (4, 8, 12, 16)),
    Ladder("solid", "solid", "elements", (4, 8)),
    Ladder("kratos", "Kratos' thin shell", "elements", (8, 16, 32)),
    Ladder("calculix", "CalculiX, 20-node bricks", "elements", (4, 6, 8, 12)),
    Ladder("felupe", "FElupe, 20-node bricks", "elements", (4, 6, 8)),
    Ladder("mujoco", "MuJoCo's flexible sheet", "grid", (5, 9)),
)


def rows(say: Callable[[str], None]) -> Iterator[PeerRow]:
    """A row per model and size; say: called with each."""
    scene, codes = load(SCENE), known_codes()
    points = scene.probe_points()
    say(f"shell {TRUTH}, the reference")
    truth = solve(resolve(scene, Elements("shell", TRUTH))).require_stable().displacement(points)
    for model, code, setting, sizes, calibration in LADDERS:
        absent = model in codes and codes[model].version() is None
        for size in sizes:
            springs = {} if calibration is None else {"calibration": calibration}
            candidate = spec_of(model, {setting: size, **springs})
            shown = f"{size} × {size}"
            say(f"{code}, {shown}")
            if absent:
                yield PeerRow("statics", code, shown, False, None, (), f"absent: needs {codes[model].needs}")
                break
            last: list[Solution] = []

            def once(candidate: Spec = candidate, last: list[Solution] = last) -> float:
                last[:] = [solve(resolve(scene, candidate))]
                return last[0].solve_seconds

            try:
                seconds = repeated(once)
            except BadInput as reason:
                yield PeerRow("statics", code, shown, False, None, (), f"absent: {reason}")
                break
            off = error(last[0].displacement(points), truth) if last[0].comparable else None
            yield PeerRow("statics", code, shown, model in OURS, off, seconds, str(last[0].status))
