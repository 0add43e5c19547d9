"""A lattice that `sheetbench … --export DIR` wrote, in NumPy alone: energy, force, statics by Newton.

python read_lattice.py DIR [STEPS]          STEPS of the load, 1 unless given
"""

import sys

import numpy as np


def differences(lattice):
    """Matrices that take positions (n, 3) to the vectors that springs see: along links, across cells."""
    of = np.eye(len(lattice["positions"]))
    found = {"link": of[lattice["link_masses"][:, 1]] - of[lattice["link_masses"][:, 0]]}
    for kind in ("area", "strain"):
        corner = of[lattice[f"{kind}_corners"]].mean(axis=2)  # of one mass or several
        found[kind] = corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1]
    return found


def dot(a, b):
    return np.sum(a * b, axis=1, keepdims=True)


def gradient(lattice, along, u):
    """Energy [J] of all springs and its gradient (n, 3) [N] at displacements u (n, 3) [m]."""
    rest, x = lattice["positions"], lattice["positions"] + u
    k, r = lattice["link_stiffness"][:, None], along["link"] @ x
    stretch = np.sqrt(dot(r, r)) - lattice["link_rest_length"][:, None]
    energy = 0.5 * np.sum(k * stretch**2)
    g = along["link"].T @ (k * stretch / np.sqrt(dot(r, r)) * r)
    k, a0, (first, second) = lattice["area_stiffness"][:, None], lattice["area_rest"][:, None], along["area"]
    d1, d2, c = first @ x, second @ x, np.cross(first @ x, second @ x)
    strain = 0.5 * np.sqrt(dot(c, c)) / a0 - 1
    energy += 0.5 * np.sum(k * strain**2 * a0)
    turned = 0.5 * k * strain * c / np.sqrt(dot(c, c))
    g += first.T @ np.cross(d2, turned) + second.T @ np.cross(turned, d1)
    k, a0, (first, second) = lattice["strain_stiffness"], lattice["strain_rest"][:, None], along["strain"]
    over_a, over_b = (first - second) / 2, (first + second) / 2
    a, b, aa, bb = over_a @ x, over_b @ x, *(dot(side @ rest, side @ rest) for side in (over_a, over_b))
    e = np.hstack([(dot(a, a) / aa - 1) / 2, (dot(b, b) / bb - 1) / 2, dot(a, b) / a0])
    t1, t2, t3 = np.hsplit(k * e, 3)
    energy += 0.5 * np.sum(k * e**2 * a0)
    g += over_a.T @ (t1 * a0 / aa * a + t3 * b) + over_b.T @ (t2 * a0 / bb * b + t3 * a)
    return energy, g


def equilibrium(lattice, along, steps=1):
    """Displacements (n, 3) at rest: Newton, the tangent by differences, supports by multipliers.

    The load comes in `steps`, in twice as many where Newton does not converge.
    """
    n, holds = len(lattice["positions"]), len(lattice["hold_axis"])
    held = np.zeros((holds, n, 3))
    for row, masses in enumerate(lattice["hold_masses"]):
        np.add.at(held, (row, masses, lattice["hold_axis"][row]), 1 / len(masses))
    held = held.reshape(holds, 3 * n)
    u, push, h = np.zeros(3 * n), np.zeros(holds), 1e-7 * lattice["link_rest_length"].max()
    for part in np.arange(1, steps + 1) / steps:
        for _ in range(20):
            near = np.vstack([u, u + h * np.eye(3 * n)]).reshape(-1, n, 3)
            force, *ahead = (gradient(lattice, along, v)[1].ravel() for v in near)
            tangent = np.block([[(ahead - force).T / h, held.T], [held, np.zeros((holds, holds))]])
            unbalanced = part * lattice["load"].ravel() - force - held.T @ push
            missing = part * lattice["hold_displacement"] - held @ u
            step = np.linalg.solve(tangent, np.concatenate([unbalanced, missing]))
            u, push = u + step[: 3 * n], push + step[3 * n :]
            moved = np.abs(step[: 3 * n]).max() / max(np.abs(u).max(), 1e-300)
            if not 1e-9 < moved < 1e3:
                break
        if not moved <= 1e-9:
            if steps >= 64:
                sys.exit(f"no equilibrium found in {steps} steps of the load: try more")
            return equilibrium(lattice, along, 2 * steps)
    return u.reshape(n, 3)


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit("usage: python read_lattice.py DIR [STEPS]")
    lattice = dict(np.load(f"{sys.argv[1]}/lattice.npz"))
    if lattice["pressure"] or len(lattice["couple_moment"]):
        sys.exit("this reader knows dead loads only")
    along, states, forces = differences(lattice), lattice["state_displacement"], lattice["state_force"]
    found = np.array([gradient(lattice, along, state)[1] for state in states])
    largest = np.abs(found - forces).max() / np.abs(forces).max()
    u, truth = equilibrium(lattice, along, int([*sys.argv, 1][2])), states[-1]
    off = np.abs(u - truth).max() / np.abs(truth).max()
    print(f"forces of {len(states)} states off by {largest:.1e}, displacements at rest by {off:.1e}")
    if largest < 1e-9 and off > 1e-6:
        print("another equilibrium than the folder's: try more STEPS of the load")
    sys.exit(not (largest < 1e-9 and off < 1e-6))
