"""One compiled pass over all springs and dampers gives the families' own forces, energy and power."""

import numpy as np
import pytest
from dynamic_cases import ROD, make_scene
from lattice_cases import ALL, assembly_of, dense
from lattice_cases import state as lattice_state

import lumped
from lumped import System, build_problem
from lumped.springs.all_families import AllFamilies
from lumped.springs.packed_forces import add_forces
from lumped.springs.packing import pack, scratch
from sheetbench import scenes
from sheetbench.scenes import PerDirection

E = np.finfo(float).eps


def packed(system):
    assembly = system.assembly
    return pack(assembly.lattice, assembly.springs, system.damping.dampers)


def state(system, size=1e-3, seed=0):
    """A displacement that stretches links by some percent, and a velocity."""
    rng = np.random.default_rng(seed)
    return (size * rng.standard_normal((system.assembly.pattern.size, 3)) for _ in range(2))


SHEET = make_scene(damping_time=1e-3)
FIBRES = SHEET.replace(
    kind="orthotropic", young_1=54.5e6, young_2=8e6, poisson_12=0.35, shear_12=4e6, angle=0.5,
)  # fmt: skip
TABLE = scenes.DamperSet.model_validate(
    {"axial": 0.3, "diagonal": 0.0, "vertical": 1.0, "cross": {"x": 0.2, "y": 0.1}}
)
CASES = {
    "equal": (SHEET, {"grid": (9, 9)}),
    "oblong": (SHEET, {"grid": (4, 7)}),
    "long lines": (SHEET, {"grid": (140, 3)}),
    "graded, with strain springs": (SHEET, {"grid": (6, 5), "method": "consistent", "grading": 0.5}),
    "neo-hookean": (SHEET, {"grid": (5, 6), "method": "hyperelastic"}),
    "neo-hookean, graded, three layers": (
        SHEET,
        {"grid": (4, 5, 3), "method": "hyperelastic", "grading": 0.5},
    ),
    "fibres": (FIBRES, {"grid": (5, 6), "cells": scenes.Cells.of(FIBRES.sheet, FIBRES.material)}),
    "three layers": (SHEET, {"grid": (5, 5, 3), "method": "moduli"}),
    "dampers of a table": (make_scene().replace(dampers=TABLE), {"grid": (5, 6)}),
    "with rows of a chain": (
        make_scene("one-edge-clamped", actuators=[ROD], damping_time=1e-3),
        {"grid": (5, 5)},
    ),
}


@pytest.mark.parametrize(("scene", "options"), CASES.values(), ids=CASES)
def test_forces_energy_and_power_are_the_families(scene, options):
    system = System(scene, build_problem(scene, lumped.calibrate(scene.sheet, scene.material, **options)))
    u, v = state(system)
    packing = packed(system)
    room = scratch(packing)
    energy, elastic = system.assembly.force(u)
    by_velocity = AllFamilies(system.damping.dampers, system.assembly.pattern).tangent(u, share=0.0)
    damping = system.problem.system.apply(by_velocity, v)  # the force is linear in v
    power = float(np.sum(damping * v))
    for with_elastic, with_damping in ((True, True), (True, False), (False, True)):
        force = np.zeros_like(u)
        stored, taken = add_forces(u, v, with_elastic, with_damping, packing, room, force)
        wanted = with_elastic * elastic + with_damping * damping
        # a force is a sum of some thirty springs', each with a few operations' rounding
        assert np.abs(force - wanted).max() < 200 * E * np.abs(wanted).max()
        assert stored == pytest.approx(with_elastic * energy, rel=1e-12)
        assert taken == pytest.approx(with_damping * power, rel=1e-12)


def test_dampers_of_the_seeds_per_direction_law_are_of_its_mean_stiffness():
    assembly = assembly_of((4, 5, 2), **{**ALL, "axial": PerDirection(x=90.0, y=70.0, z=50.0)})
    u, v = lattice_state(assembly), lattice_state(assembly, seed=1)
    dampers, force = assembly.all_families.damped(0.1), np.zeros_like(u)
    packing = pack(assembly.lattice, (), dampers)
    _, power = add_forces(u, v, False, True, packing, scratch(packing), force)
    by_velocity = AllFamilies(dampers, assembly.pattern).tangent(u, share=0.0)
    wanted = (dense(assembly, by_velocity) @ v.ravel()).reshape(-1, 3)
    assert not assembly.conservative
    of_links = sum(
        family.stiffness.reshape(len(family), -1).mean(axis=1).sum()
        for family in assembly.all_families.all_links
    )
    assert dampers[0].stiffness.sum() == pytest.approx(0.1 * of_links, rel=1e-12)
    assert np.abs(force - wanted).max() < 200 * E * np.abs(wanted).max()
    assert power == pytest.approx(np.sum(force * v), rel=1e-12)


def test_small_displacements_lose_no_digits():
    scene = make_scene(damping_time=1e-3)
    system = System(scene, build_problem(scene, lumped.calibrate(scene.sheet, scene.material, grid=(9, 9))))
    u, v = state(system, size=1e-12)
    wanted = system.assembly.force(u)[1]
    packing, force = packed(system), np.zeros_like(u)
    add_forces(u, v, True, False, packing, scratch(packing), force)
    assert np.abs(force - wanted).max() < 200 * E * np.abs(wanted).max()
