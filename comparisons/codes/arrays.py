"""A lattice as named arrays: what `lattice.npz` and `lattice.mat` hold. All numbers count from 0.

A corner of a cell is the mean of as many masses as the lattice has layers; where it is one mass alone, that
stands there as often. So do the masses of a hold.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from lumped import Description

NAMES = {  # and what they are
    "positions": "(n, 3) rest positions of the masses [m]",
    "index": "(n, 3) of each mass along x, along y, through the thickness",
    "mass": "(n,) [kg]",
    "damping_rate": "drag of each mass over its mass [1/s]",
    "link_masses": "(m, 2) masses at the ends",
    "link_family": "(m,) names",
    "link_rest_length": "(m,) [m]",
    "link_stiffness": "(m,) [N/m]",
    "link_damping": "(m,) [N s/m]",
    "area_corners": "(a, 4, p) masses whose mean is a corner, corners in turn",
    "area_rest": "(a,) rest area [m2]",
    "area_stiffness": "(a,) [N/m]",
    "area_damping": "(a,) [N s/m]",
    "strain_corners": "(s, 4, p) as area_corners",
    "strain_rest": "(s,) rest area [m2]",
    "strain_natural": "(s, 3) A.A, B.B, A.B of mean sides without stress [m2]",
    "strain_stiffness": "(s, 3) of e1, e2, g [N/m]",
    "strain_damping": "(s, 3) [N s/m]",
    "coupling_corners": "(f, 4, p) as area_corners",
    "coupling_rest": "(f,) rest area [m2]",
    "coupling_natural": "(f, 3) A.A, B.B, A.B of mean sides without stress [m2]",
    "coupling_stiffness": "(f, 3) of e1 e2, e1 g, e2 g [N/m]",
    "coupling_damping": "(f, 3) [N s/m]",
    "rubber_corners": "(r, 4, p) as area_corners",
    "rubber_rest": "(r,) rest area [m2]",
    "rubber_stiffness": "(r, 8) c10, c01, c20, c30, volume [N/m], limit [-], two of the sides [N/m]",
    "face_corners": "(f, 4, p) as area_corners",
    "face_rest": "(f,) rest area [m2]",
    "face_stiffness": "(f,) [N/m]",
    "hold_masses": "(h, p) masses whose mean displacement is held",
    "hold_axis": "(h,) along 0 = x, 1 = y, 2 = z",
    "hold_displacement": "(h,) [m]",
    "load": "(n, 3) dead forces [N]",
    "pressure": "(c,) [Pa] on each of the cells pressed",
    "pressed_corners": "(c, 4, p) as area_corners",
    "couple_masses": "(e, 2) top and bottom of an edge's column",
    "couple_before": "(e, p) masses of the column before it",
    "couple_after": "(e, p) of the one after it",
    "couple_moment": "(e,) [N m]",
    "obstacle_kind": "(o,) 0 plane, 1 sphere, 2 cylinder",
    "obstacle_position": "(o, 3) of a plane's point, a centre, a point of an axis, where it is at last [m]",
    "obstacle_direction": "(o, 3) unit normal or axis, 0 of a sphere",
    "obstacle_radius": "(o,) [m], 0 of a plane",
    "contact_obstacle": "(t,) obstacle that a point may touch, from 0",
    "contact_corners": "(t, 4, p) masses whose mean is a corner",
    "contact_weights": "(t, 4) of the corners",
    "contact_area": "(t,) [m2]",
    "contact_offset": "(t,) distance at which it touches [m]",
    "contact_stiffness": "(t,) k of the pressure k d [N/m3]",
    "state_name": "(q,) names",
    "state_displacement": "(q, n, 3) [m]",
    "state_force": "(q, n, 3) gradient of the energy of springs and contact [N]",
    "state_energy": "(q,) energy of springs and contact [J]",
}


def arrays(lattice: Description) -> dict[str, np.ndarray]:
    """Return the arrays by the names of `NAMES`."""
    layers = 1 + int(lattice.index[:, 2].max())
    found: dict[str, np.ndarray] = {
        "positions": lattice.positions,
        "index": lattice.index,
        "mass": lattice.mass,
        "damping_rate": np.array(lattice.damping_rate),
        **{f"link_{name}": values for name, values in vars(lattice.links).items()},
        "hold_masses": _repeated([hold.masses for hold in lattice.holds], layers),
        "hold_axis": np.array([hold.axis for hold in lattice.holds], dtype=int),
        "hold_displacement": np.array([hold.displacement for hold in lattice.holds]),
        "load": lattice.dead,
        "pressure": lattice.pressure,
        "pressed_corners": lattice.pressed,
        "couple_masses": np.array([(c.top, c.bottom) for c in lattice.couples], dtype=int).reshape(-1, 2),
        "couple_before": _repeated([couple.before for couple in lattice.couples], layers),
        "couple_after": _repeated([couple.after for couple in lattice.couples], layers),
        "couple_moment": np.array([couple.moment for couple in lattice.couples]),
        **lattice.contact,
        "state_name": np.array([state.name for state in lattice.states]),
        **{
            f"state_{name}": np.array([getattr(state, name) for state in lattice.states])
            for name in ("displacement", "force", "energy")
        },
    }
    for kind, components in (("area", 1), ("strain", 3), ("coupling", 3), ("rubber", 8), ("face", 1)):
        cells = [table for table in lattice.cells if table.kind == kind]
        corners = [np.repeat(t.corners, layers // t.corners.shape[2], axis=2) for t in cells]
        found[f"{kind}_corners"] = np.concatenate([np.empty((0, 4, layers), dtype=int), *corners])
        found[f"{kind}_rest"] = np.concatenate([np.empty(0), *(table.rest_area for table in cells)])
        found[f"{kind}_natural"] = np.concatenate([np.empty((0, 3)), *(table.natural for table in cells)])
        for name in ("stiffness", "damping"):
            values = np.concatenate([np.empty((0, components)), *(getattr(table, name) for table in cells)])
            found[f"{kind}_{name}"] = values[:, 0] if components == 1 else values
    return {name: found[name] for name in NAMES}


def _repeated(groups: Sequence[tuple[int, ...]], width: int) -> np.ndarray:
    """Masses of each group as often as it takes to fill a row of `width`, (g, width)."""
    rows = [np.repeat(group, width // len(group)) for group in groups]
    return np.array(rows, dtype=int).reshape(-1, width)
