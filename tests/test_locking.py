"""Neither thin nor nearly incompressible sheets lock: fixed 8 × 8 meshes beside converged ones; the plot."""

from __future__ import annotations

from pathlib import Path

import pytest

from comparisons.locking import picture
from fem_reference.verification import Row, run
from fem_reference.verification.mindlin_plates import deflection
from fem_reference.verification.rows import relatively


@pytest.mark.parametrize("model", ["plate", "shell"])
def test_thin_to_thick_within_2_percent(model: str) -> None:
    """h/a from 1e-5 to 0.2."""
    rows = list(run([f"locking-{model}"]))
    assert len(rows) == 7
    assert max(row.relative or 0.0 for row in rows) < 0.02
    assert all(row.passed for row in rows)


@pytest.mark.parametrize("poisson", [0.3, 0.48, 0.499, 0.4999])
def test_solid_within_1_percent_at_the_seeds_slenderness(poisson: float) -> None:
    """h/a = 3/188."""
    coarse, fine = (deflection("solid", "clamped", 3 / 188, n, poisson) for n in (8, 14))
    assert coarse == pytest.approx(fine, rel=0.01)


@pytest.mark.slow
def test_solid_within_1_percent_as_it_becomes_incompressible() -> None:
    """ν = 0.3, 0.48, 0.499, 0.4999 and h/a from 1e-3 to 0.2."""
    rows = list(run(["locking-solid"]))
    assert len(rows) == 20
    assert max(row.relative or 0.0 for row in rows) < 0.01
    assert all(row.passed for row in rows)


def test_picture(tmp_path: Path) -> None:
    def made(model: str, ratio: float, poisson: float) -> Row:
        quantity = f"w D/qL⁴ at h/a = {ratio:g}, ν = {poisson:g}"
        return relatively(f"locking-{model}", quantity, "8 × 8", 1.0, 1.001, 0.02)

    rows = [made(model, ratio, 0.3) for model in ("plate", "solid") for ratio in (1e-5, 0.1)]
    picture(tmp_path / "locking.png", rows)
    assert (tmp_path / "locking.png").stat().st_size > 5000
