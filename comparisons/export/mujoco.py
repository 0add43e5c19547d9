"""A lattice for MuJoCo, as MJCF: masses that slide along x, y and z, links as spatial tendons.

A tendon of two sites is as long as they are apart and pulls with stiffness × (length − springlength), a
link's force to the last digit: at a lattice's equilibrium MuJoCo's accelerations vanish (tests). Masses that
are held stand where they are held, without joints there. Where the mean of several is held, as hinged edges
hold their layers', a fixed tendon is that mean, and an equality keeps it. MuJoCo's constraints yield: at rest
by 1 − d of what the edge's springs would do to it in a step, with d as near to 1 as there is (0.9999), and
twice the time step to come back. Drag is joint damping. Loads other than weight are motors, whose keyframe
`loaded` says how much. The time step is half of what the stiffest motion bears, by Gershgorin's bound.

Source: MuJoCo's XML reference, `tendon/spatial`, `tendon/fixed`, `equality/tendon`, `keyframe`; the chapter
on computation, of solver parameters.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from comparisons.export.links import held_masses, held_means, require_links, weight_and_rest, words
from sheetbench.scenes import Scene

if TYPE_CHECKING:
    from lumped import Description

AXES = np.eye(3, dtype=int)
RIGID = 0.9999  # d of MuJoCo's constraints, the nearest to 1 that it takes
SMALL = 1e-9  # kg m²: what does not turn needs an inertia all the same


def to_mjcf(lattice: Description, scene: Scene) -> str:
    """Return the model's text. Raises BadInput for what MuJoCo's springs cannot say (`require_links`)."""
    require_links(lattice, "mujoco", means=True)
    gravity, forces = weight_and_rest(lattice, scene)
    step = _time_step(lattice)
    parts = [
        f'<mujoco model="lattice">\n<option timestep="{step!r}" gravity="{words(gravity)}">'
        '<flag contact="disable"/></option>\n<worldbody>',
        *_bodies(lattice),
        "</worldbody>\n<tendon>",
        *_tendons(lattice),
        *_means(lattice),
        "</tendon>",
        *_equalities(lattice, step),
        *_motors(lattice, forces),
        "</mujoco>\n",
    ]
    return "\n".join(parts)


def _time_step(lattice: Description) -> float:
    links = lattice.links
    carried = np.zeros(len(lattice.mass))
    np.add.at(carried, links.masses.ravel(), np.repeat(links.stiffness, 2))
    return float(1.0 / np.sqrt((2.0 * carried / lattice.mass).max()))


def _bodies(lattice: Description) -> Iterator[str]:
    held = held_masses(lattice)
    for number, (rest, mass) in enumerate(zip(lattice.positions, lattice.mass.tolist(), strict=True)):
        fixed = held.get(number, {})
        at = rest + [fixed.get(axis, 0.0) for axis in range(3)]
        joints = "".join(
            f'<joint name="{_joint(number, axis)}" type="slide" axis="{words(AXES[axis])}" '
            f'damping="{lattice.damping_rate * mass!r}"/>'
            for axis in range(3)
            if axis not in fixed
        )
        yield (
            f'<body name="mass{number}" pos="{words(at)}">{joints}<inertial pos="0 0 0" mass="{mass!r}" '
            f'diaginertia="{SMALL} {SMALL} {SMALL}"/><site name="site{number}"/></body>'
        )


def _tendons(lattice: Description) -> Iterator[str]:
    links = lattice.links
    for (a, b), length, k, c in zip(
        links.masses.tolist(),
        links.rest_length.tolist(),
        links.stiffness.tolist(),
        links.damping.tolist(),
        strict=True,
    ):
        yield (
            f'<spatial springlength="{length!r}" stiffness="{k!r}" damping="{c!r}">'
            f'<site site="site{a}"/><site site="site{b}"/></spatial>'
        )


def _means(lattice: Description) -> Iterator[str]:
    for number, (masses, axis, _) in enumerate(held_means(lattice)):
        share = 1.0 / len(masses)
        joints = (f'<joint joint="{_joint(mass, axis)}" coef="{share!r}"/>' for mass in masses)
        yield f'<fixed name="mean{number}">{"".join(joints)}</fixed>'


def _equalities(lattice: Description, step: float) -> Iterator[str]:
    held = held_means(lattice)
    if held:
        yield "<equality>"
        for number, (_, _, mean) in enumerate(held):
            yield (
                f'<tendon tendon1="mean{number}" polycoef="{mean!r} 0 0 0 0" '
                f'solref="{2.0 * step!r} 1" solimp="{RIGID} {RIGID} 0.001 0.5 2"/>'
            )
        yield "</equality>"


def _motors(lattice: Description, forces: np.ndarray) -> Iterator[str]:
    held = held_masses(lattice)
    loaded = [(n, axis) for n, axis in np.argwhere(forces).tolist() if axis not in held.get(n, {})]
    if loaded:
        yield "<actuator>"
        yield from (f'<motor joint="{_joint(n, axis)}"/>' for n, axis in loaded)
        yield "</actuator>"
        values = words(np.array([forces[n, axis] for n, axis in loaded]))
        yield f'<keyframe><key name="loaded" ctrl="{values}"/></keyframe>'


def _joint(mass: int, axis: int) -> str:
    return f"mass{mass}{'xyz'[axis]}"
