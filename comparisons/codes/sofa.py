"""A lattice for SOFA, as a scene of plain XML: points, masses and springs between two of them.

Components as named from v24.06 on; before, `SpringForceField` was `StiffSpringForceField`, and constraints
`FixedConstraint` and `PartialFixedConstraint`. A spring is "first second stiffness damping length". Held
points start where they are held, and springs have their own lengths, so that a bent edge bends the sheet from
the first step on. Implicit Euler steps of 10 ms bring it to rest; for motion make them shorter.

Source: SOFA's component reference, `Sofa.Component.SolidMechanics.Spring`, and its list of renamed ones.
"""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.etree import ElementTree

import numpy as np

from comparisons.codes.links import held_masses, require_links, weight_and_rest, words
from sheetbench.scenes import Scene

if TYPE_CHECKING:
    from lumped import Description

PLUGINS = (
    "Sofa.Component.Constraint.Projective",
    "Sofa.Component.LinearSolver.Direct",
    "Sofa.Component.Mass",
    "Sofa.Component.MechanicalLoad",
    "Sofa.Component.ODESolver.Backward",
    "Sofa.Component.SolidMechanics.Spring",
    "Sofa.Component.StateContainer",
    "Sofa.Component.Topology.Container.Constant",
)


def to_sofa(lattice: Description, scene: Scene) -> str:
    """Return the scene's text. Raises BadInput for what SOFA's springs cannot say (`require_links`)."""
    require_links(lattice, "sofa", means=False)
    held = held_masses(lattice)
    gravity, forces = weight_and_rest(lattice, scene)
    places = lattice.positions.copy()
    for number, axes in held.items():
        places[number] += [axes[axis] for axis in range(3)]

    root = ElementTree.Element("Node", name="root", dt="0.01", gravity=words(gravity))
    for name in PLUGINS:
        _put(root, "RequiredPlugin", name=name)
    _put(root, "DefaultAnimationLoop")
    sheet = _put(root, "Node", name="sheet")
    _put(sheet, "EulerImplicitSolver", rayleighMass=repr(lattice.damping_rate), rayleighStiffness="0")
    _put(sheet, "SparseLDLSolver", template="CompressedRowSparseMatrixMat3x3")
    _put(
        sheet,
        "MechanicalObject",
        template="Vec3d",
        position=words(places.ravel()),
        rest_position=words(lattice.positions.ravel()),
    )
    links = lattice.links
    _put(sheet, "MeshTopology", edges=words(links.masses.ravel()))
    _put(sheet, "DiagonalMass", template="Vec3d,Vec3d", vertexMass=words(lattice.mass))
    _fix(sheet, {number: frozenset(axes) for number, axes in held.items()})
    springs = zip(
        links.masses.tolist(),
        links.stiffness.tolist(),
        links.damping.tolist(),
        links.rest_length.tolist(),
        strict=True,
    )
    _put(
        sheet,
        "SpringForceField",
        template="Vec3d",
        spring=" ".join(f"{a} {b} {k!r} {c!r} {length!r}" for (a, b), k, c, length in springs),
    )
    loaded = np.flatnonzero(forces.any(axis=1))
    if len(loaded):
        _put(
            sheet,
            "ConstantForceField",
            template="Vec3d",
            indices=words(loaded),
            forces=words(forces[loaded].ravel()),
        )
    ElementTree.indent(root)
    return '<?xml version="1.0"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def _fix(sheet: ElementTree.Element, held: dict[int, frozenset[int]]) -> None:
    """A constraint for all points that are held along the same axes."""
    for axes in sorted(set(held.values()), key=sorted):
        indices = words(np.array(sorted(n for n, own in held.items() if own == axes)))
        if len(axes) == 3:
            _put(sheet, "FixedProjectiveConstraint", indices=indices)
        else:
            directions = words(np.array([int(axis in axes) for axis in range(3)]))
            _put(sheet, "PartialFixedProjectiveConstraint", indices=indices, fixedDirections=directions)


def _put(parent: ElementTree.Element, tag: str, **data: str) -> ElementTree.Element:
    return ElementTree.SubElement(parent, tag, data)
