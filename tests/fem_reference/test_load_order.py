"""The order of loads: an edge bent first and the weight put on afterwards fold elsewhere than both together.

A sheet on an edge that is bent down to −8 1/m, h/a = 1/75. CalculiX (C3D20R, two meshes) bends the edge
first: its limit point is at 0.7645 of the weight, with −15.1 mm at P3. Statics let all loads grow together;
the other order is a series of scenes, each begun in the shape of the one before.
"""

import numpy as np
import pytest
from cases import sheet

import fem_reference
from comparisons.comparison.branches import shape
from sheetbench.answers.solution import Status
from sheetbench.scenes import Curved

LIMIT, AT_LIMIT = 0.7645, -15.1e-3  # shares of the weight, and uz at P3 [m], by CalculiX
SHARES = (0.0, 0.4, 0.65, 0.74, 0.995 * LIMIT, 1.005 * LIMIT)
P3 = [(0.15, 0.075)]


def bent(share):
    """With a share of the weight, by its density."""
    density, supports = 1200.0 * (share or 1.0), (Curved(edge="x0", curvature=-8.0),)
    return sheet(0.15, 0.15, 0.002, 1e7, 0.45, density, weight=9.81 if share else 0.0, supports=supports)


def sag(found):
    assert found.status is Status.CONVERGED, found.message
    return float(found.displacement(P3)[0, 2])


@pytest.mark.parametrize("elements", [12, pytest.param(16, marks=pytest.mark.slow)])
def test_bent_first_the_shell_folds_at_the_weight_at_which_calculix_does(elements):
    """Measured: between 0.7656 and 0.7664 on 12 elements, 0.7648 and 0.7656 on 16, with −15.17 mm."""
    before, found, sags = bent(0.0), fem_reference.solve(bent(0.0), model="shell", elements=elements), []
    for share in SHARES[1:]:
        scene, last, start = bent(share), found, before
        found = fem_reference.solve(
            scene, model="shell", elements=elements, near=lambda at, s=start, f=last: shape(s, f, at)
        )
        sags.append(sag(found))
        before = scene
    *smooth, folded = sags
    assert np.diff(smooth).max() < 0.0  # ever lower, without a jump
    assert AT_LIMIT < smooth[-1] < 0.9 * AT_LIMIT
    assert folded < 2.0 * AT_LIMIT
