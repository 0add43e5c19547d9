"""A lattice for SOFA, as a scene of plain XML: points, masses and springs between two of them.

Components as named from v24.06 on; before, `SpringForceField` was `StiffSpringForceField`, and constraints
`FixedConstraint` and `PartialFixedConstraint`. A spring is "first second stiffness damping length". Held
points start where they are held, and springs have their own lengths, so that a bent edge bends the sheet from
the first step on. Implicit Euler steps of 10 ms bring it to rest; for motion make them shorter.

Source: SOFA's component reference, `Sofa.Component.SolidMechanics.Spring`, and its list of renamed ones.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from comparisons.codes.files import words
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene

if TYPE_CHECKING:
    from lumped import Description

SCENE = """\
<?xml version="1.0"?>
<Node name="root" dt="0.01" gravity="{gravity}">
  <RequiredPlugin name="Sofa.Component.Constraint.Projective" />
  <RequiredPlugin name="Sofa.Component.LinearSolver.Direct" />
  <RequiredPlugin name="Sofa.Component.Mass" />
  <RequiredPlugin name="Sofa.Component.MechanicalLoad" />
  <RequiredPlugin name="Sofa.Component.ODESolver.Backward" />
  <RequiredPlugin name="Sofa.Component.SolidMechanics.Spring" />
  <RequiredPlugin name="Sofa.Component.StateContainer" />
  <RequiredPlugin name="Sofa.Component.Topology.Container.Constant" />
  <DefaultAnimationLoop />
  <Node name="sheet">
    <EulerImplicitSolver rayleighMass="{drag!r}" rayleighStiffness="0" />
    <SparseLDLSolver template="CompressedRowSparseMatrixMat3x3" />
    <MechanicalObject template="Vec3d" position="{places}" rest_position="{rest}" />
    <MeshTopology edges="{edges}" />
    <DiagonalMass template="Vec3d,Vec3d" vertexMass="{masses}" />
{supports}    <SpringForceField template="Vec3d" spring="{springs}" />
{loads}  </Node>
</Node>
"""


def to_sofa(lattice: Description, scene: Scene) -> str:
    """Return the scene's text. Raises BadInput for springs that are not between two masses, loads that are
    not dead, and supports that do not hold one mass each."""
    if lattice.cells:
        raise BadInput(
            "--for sofa: has springs between two points alone, and these springs have "
            f"{' and '.join(sorted({table.kind for table in lattice.cells}))} springs of cells; "
            "take --calibration central"
        )
    if any(len(hold.masses) > 1 for hold in lattice.holds):
        raise BadInput(
            "--for sofa: hinged and held edges hold the mean of their layers, which has no plain "
            "form there; clamped and curved edges only"
        )
    if len(lattice.pressure) or lattice.couples:
        raise BadInput("--for sofa: pressure and edge moments follow the sheet; dead loads only")
    places, held = lattice.positions.copy(), np.zeros(lattice.positions.shape, dtype=bool)
    for hold in lattice.holds:
        held[hold.masses[0], hold.axis] = True
        places[hold.masses[0], hold.axis] += hold.displacement
    gravity = np.zeros(3) if scene.gravity is None else np.array(scene.gravity.last_acceleration)
    forces = lattice.dead - lattice.mass[:, None] * gravity
    forces[np.abs(forces) < 1e-12 * np.abs(lattice.dead).max(initial=0.0)] = 0.0
    loaded, links = np.flatnonzero(forces.any(axis=1)), lattice.links
    columns = (links.masses, links.stiffness, links.damping, links.rest_length)
    springs = zip(*(column.tolist() for column in columns), strict=True)
    return SCENE.format(
        gravity=words(gravity),
        drag=lattice.damping_rate,
        places=words(places),
        rest=words(lattice.positions),
        edges=words(links.masses),
        masses=words(lattice.mass),
        supports="".join(_fixed(held, axes) for axes in np.unique(held, axis=0)[::-1] if axes.any()),
        springs=" ".join(f"{a} {b} {k!r} {c!r} {length!r}" for (a, b), k, c, length in springs),
        loads=f'    <ConstantForceField template="Vec3d" indices="{words(loaded)}" '
        f'forces="{words(forces[loaded])}" />\n'
        if len(loaded)
        else "",
    )


def _fixed(held: np.ndarray, axes: np.ndarray) -> str:
    """A constraint for all points that are held along the same axes."""
    indices = words(np.flatnonzero((held == axes).all(axis=1)))
    if axes.all():
        return f'    <FixedProjectiveConstraint indices="{indices}" />\n'
    along = words(axes.astype(int))
    return f'    <PartialFixedProjectiveConstraint indices="{indices}" fixedDirections="{along}" />\n'
