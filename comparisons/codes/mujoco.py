"""MuJoCo's models, as MJCF: a lattice's springs as tendons, and MuJoCo's own sheet of triangles, a flex.

Masses and vertices slide along x, y and z; what is held has no joints there. Loads other than weight are
motors, whose keyframe `loaded` says how much.

A tendon of two sites is as long as they are apart and pulls with stiffness × (length − springlength), a
link's force to the last digit: at a lattice's equilibrium MuJoCo's accelerations vanish (tests). Where the
mean of several masses is held, as hinged edges hold their layers', a fixed tendon is that mean, and an
equality keeps it. MuJoCo's constraints yield: at rest by 1 − d of what the edge's springs would do to it in a
step, with d as near to 1 as there is (0.9999), and twice the time step to come back. Drag is joint damping.
The time step is half of what the stiffest motion bears, by Gershgorin's bound.

Source: MuJoCo's XML reference, `tendon/spatial`, `tendon/fixed`, `equality/tendon`, `keyframe`,
`deformable/flex`; the chapter on computation, of solver parameters.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.codes.links import held_masses, held_means, require_links, weight_and_rest, words
from comparisons.codes.sheet_mesh import SheetMesh
from sheetbench.scenes import Scene

if TYPE_CHECKING:
    from lumped import Description

AXES = np.eye(3, dtype=int)
RIGID = 0.9999  # d of MuJoCo's constraints, the nearest to 1 that it takes
SMALL = 1e-9  # kg m²: what does not turn needs an inertia all the same
FAR = 50.0  # radii: half the length of a cylinder that touches the sheet
FLEX_STEP = 0.002  # s, of implicit steps


def to_mjcf(lattice: Description, scene: Scene) -> str:
    """Return the lattice's model. Raises BadInput for what MuJoCo's springs cannot say (`require_links`)."""
    require_links(lattice, "mujoco", means=True)
    gravity, forces = weight_and_rest(lattice, scene)
    step, held = _time_step(lattice), held_masses(lattice)
    rows = enumerate(zip(lattice.positions, lattice.mass.tolist(), strict=True))
    bodies = (
        _body(
            f"mass{n}",
            rest + [held.get(n, {}).get(axis, 0.0) for axis in range(3)],
            mass,
            held.get(n, {}),
            lattice.damping_rate * mass,
        )
        for n, (rest, mass) in rows
    )
    inner = ["<tendon>", *_tendons(lattice), *_means(lattice), "</tendon>", *_equalities(lattice, step)]
    loaded = {
        f"mass{n}{'xyz'[axis]}": forces[n, axis]
        for n, axis in np.argwhere(forces).tolist()
        if axis not in held.get(n, {})
    }
    return _model("lattice", f'timestep="{step!r}"', gravity, bodies, inner, loaded)


def sheet_mjcf(mesh: SheetMesh, keys: Mapping[str, float]) -> str:
    """Return the model of a flex of the mesh's triangles, with MuJoCo's parameters `keys`."""
    every, held = range(3), mesh.held.tolist()
    bodies = (
        _body(f"mass{n}", place, mass, every if held[n] else ())
        for n, (place, mass) in enumerate(zip(mesh.vertices, mesh.masses.tolist(), strict=True))
    )
    damping = f' damping="{keys["damping"]!r}"' if "damping" in keys else ""
    radius = mesh.offset if mesh.obstacles else 1e-4
    flex = (
        f'<deformable><flex name="sheet" dim="2" radius="{radius!r}" body="'
        f'{" ".join(f"mass{n}" for n in range(len(held)))}" element="{words(mesh.triangles.ravel())}">'
        f'<elasticity young="{keys["young"]!r}" poisson="{keys["poisson"]!r}" '
        f'thickness="{keys["thickness"]!r}" elastic2d="both"{damping}/>'
        '<contact selfcollide="none" condim="1"/></flex></deformable>'
    )
    loaded = {
        f"mass{n}{'xyz'[axis]}": mesh.forces[n, axis]
        for n, axis in np.argwhere(mesh.forces).tolist()
        if not held[n]
    }
    options = f'timestep="{FLEX_STEP}" integrator="discrete"'
    geoms = [_geom(one) for one in mesh.obstacles]
    return _model("sheet", options, mesh.gravity, [*geoms, *bodies], [flex], loaded, bool(geoms))


def _model(
    name: str,
    options: str,
    gravity: np.ndarray,
    bodies: Iterable[str],
    inner: Iterable[str],
    loaded: Mapping[str, float],
    touching: bool = False,
) -> str:
    """Return the text of a model; inner: what stands beside its bodies; loaded: motors' forces by joint;
    touching: whether there is contact."""
    parts = [
        f'<mujoco model="{name}">\n<option {options} gravity="{words(gravity)}">'
        f'<flag contact="{"enable" if touching else "disable"}"/></option>\n<worldbody>',
        *bodies,
        "</worldbody>",
        *inner,
    ]
    if loaded:
        parts += ["<actuator>", *(f'<motor joint="{joint}"/>' for joint in loaded), "</actuator>"]
        values = words(np.array(list(loaded.values())))
        parts.append(f'<keyframe><key name="loaded" ctrl="{values}"/></keyframe>')
    return "\n".join([*parts, "</mujoco>\n"])


def _body(name: str, at: np.ndarray, mass: float, fixed: Collection[int], drag: float = 0.0) -> str:
    """Return a body that slides along the axes that are not fixed; without joints or mass where all are."""
    joints = "".join(
        f'<joint name="{name}{"xyz"[axis]}" type="slide" axis="{words(AXES[axis])}" damping="{drag!r}"/>'
        for axis in range(3)
        if axis not in fixed
    )
    if joints:
        joints += f'<inertial pos="0 0 0" mass="{mass!r}" diaginertia="{SMALL} {SMALL} {SMALL}"/>'
    return f'<body name="{name}" pos="{words(at)}">{joints}<site name="{name}"/></body>'


def _time_step(lattice: Description) -> float:
    links = lattice.links
    carried = np.zeros(len(lattice.mass))
    np.add.at(carried, links.masses.ravel(), np.repeat(links.stiffness, 2))
    return float(1.0 / np.sqrt((2.0 * carried / lattice.mass).max()))


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
            f'<site site="mass{a}"/><site site="mass{b}"/></spatial>'
        )


def _means(lattice: Description) -> Iterator[str]:
    for number, (masses, axis, _) in enumerate(held_means(lattice)):
        share = 1.0 / len(masses)
        joints = (f'<joint joint="mass{mass}{"xyz"[axis]}" coef="{share!r}"/>' for mass in masses)
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


def _geom(obstacle: Mapping[str, Any]) -> str:
    """An obstacle as MuJoCo has it, its axis along z; a cylinder is FAR times as long as it is thick."""
    along, radius = obstacle.get("normal", obstacle.get("axis")), obstacle.get("radius", 0.0)
    size = {"plane": "0 0 1", "sphere": f"{radius!r}", "cylinder": f"{radius!r} {FAR * radius!r}"}
    turned = "" if along is None else f' zaxis="{words(along)}"'
    condim = 3 if obstacle["friction"] else 1
    kind, at, friction = obstacle["kind"], words(obstacle["position"]), obstacle["friction"]
    return (
        f'<geom type="{kind}" size="{size[kind]}" pos="{at}"{turned} condim="{condim}" '
        f'friction="{friction!r} 0 0"/>'
    )
