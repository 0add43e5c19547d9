"""What small lattices keep from one solve to the next, against what is found anew."""

import numpy as np
import pytest

import lumped
from lumped import lattice, pattern, supports
from lumped.springs import all_families
from sheetbench.scenes import Clamped, Pressure, load


def arrays(problem):
    """All that a lattice is solved with."""
    families = problem.assembly.all_families.families[:4]
    springs = [part for family in families if len(family) for part in family.arrays]
    constants = [part.constants if isinstance(part, tuple) else part for part in springs]
    constraints = problem.constraints
    return [
        *constants,
        *constraints.transform_arrays,
        constraints.held,
        constraints.prescribed(0.5),
        problem.loads.dead,
    ]


@pytest.mark.parametrize("name", ["two-edges-clamped", "curved-edge"])
def test_what_is_kept_is_what_would_be_found(name):
    """Springs with and without some of their families, by turns, on one lattice."""
    scene = load(name)
    full = lumped.calibrate(scene.sheet, scene.material, grid=(3, 4))
    several = [full, full.with_constant("vertical", 0.0), full.with_constant("edge_shear", 0.0), full]
    kept = [lumped.build_problem(scene, springs) for springs in several]
    assert kept[0].constraints is kept[3].constraints and kept[0].system is kept[3].system
    for problem, springs in zip(kept, several, strict=True):
        for shared in (
            lattice.build,
            pattern.of_grid,
            supports._constrain,
            all_families.springs_of,
        ):
            shared.forget()
        anew = lumped.build_problem(scene, springs)
        assert anew.constraints is not problem.constraints
        for found, expected in zip(arrays(problem), arrays(anew), strict=True):
            assert np.array_equal(found, expected)


def test_supports_alike_but_for_their_tilt_are_kept_apart():
    scene = load("one-edge-clamped")
    springs = lumped.calibrate(scene.sheet, scene.material, grid=(3, 4))
    tilted = scene.replace(supports=(Clamped(edge=scene.supports[0].edge, tilt=0.1),))
    flat, turned, again = (lumped.build_problem(s, springs).constraints for s in (scene, tilted, scene))
    assert flat is again and not flat.prescribed(1.0).any() and turned.prescribed(1.0).any()


def test_what_is_shared_between_solves_cannot_be_written_to():
    scene = load("one-edge-clamped")
    springs = lumped.calibrate(scene.sheet, scene.material, grid=(3, 4))
    problem = lumped.build_problem(scene, springs)
    built, loads = problem.assembly.lattice, problem.loads
    flat = np.zeros_like(loads.dead)
    shared = [built.positions, built.share, built.links.cells, problem.constraints.fixed]
    for array in [*shared, loads.dead, loads.force(flat)]:  # constant loads: the force is the dead one itself
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0
    pressed = scene.replace(loads=(Pressure(value=5.0),))
    loads = lumped.build_problem(pressed, springs).loads
    before = loads.dead.copy()
    loads.force(flat)[:] = 1.0  # with loads that follow the sheet: one's own
    assert np.array_equal(loads.dead, before)
