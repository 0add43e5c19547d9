"""A lattice that `sheetbench … --export DIR` wrote, in NumPy alone: energy, force, statics by Newton.

python read_lattice.py DIR [STEPS]          STEPS of the load, 1 unless given
"""

import sys

import numpy as np


def differences(lattice):
    """Return matrices from positions (n, 3) to the springs' vectors: along links, across cells."""
    of = np.eye(len(lattice["positions"]))
    matrices = {"link": of[lattice["link_masses"][:, 1]] - of[lattice["link_masses"][:, 0]]}
    for kind in ("area", "strain", "coupling", "rubber", "face"):
        corner = of[lattice[f"{kind}_corners"]].mean(axis=2)  # of one mass or several
        first, second = corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1]
        matrices[kind] = (first - second) / 2, (first + second) / 2  # mean sides
        matrices[f"{kind}_warp"] = corner[:, 0] - corner[:, 1] + corner[:, 2] - corner[:, 3]
    matrices["contact"] = np.einsum("pq,pqn->pn", lattice["contact_weights"], of[lattice["contact_masses"]])
    return matrices


def dot(a, b):
    return np.sum(a * b, axis=1, keepdims=True)


def gradient(lattice, along, u):
    """Return the energy [J] of springs and contact, and its gradient (n, 3) [N], at u (n, 3) [m]."""
    x = lattice["positions"] + u
    k, r = lattice["link_stiffness"][:, None], along["link"] @ x
    stretch = np.sqrt(dot(r, r)) - lattice["link_rest_length"][:, None]
    energy = 0.5 * np.sum(k * stretch**2)
    g = along["link"].T @ (k * stretch / np.sqrt(dot(r, r)) * r)
    k, a0, (over_a, over_b) = lattice["area_stiffness"][:, None], lattice["area_rest"][:, None], along["area"]
    a, b, c = over_a @ x, over_b @ x, np.cross(over_a @ x, over_b @ x)
    strain = np.sqrt(dot(c, c)) / a0 - 1
    energy += 0.5 * np.sum(k * strain**2 * a0)
    turned = k * strain * c / np.sqrt(dot(c, c))
    g += over_a.T @ np.cross(b, turned) + over_b.T @ np.cross(turned, a)
    for kind in ("strain", "coupling"):
        k, a0, (over_a, over_b) = lattice[f"{kind}_stiffness"], lattice[f"{kind}_rest"][:, None], along[kind]
        a, b, (aa, bb, ab) = over_a @ x, over_b @ x, np.hsplit(lattice[f"{kind}_natural"], 3)
        e = np.hstack([(dot(a, a) / aa - 1) / 2, (dot(b, b) / bb - 1) / 2, (dot(a, b) - ab) / a0])
        t = k * e
        if kind == "coupling":
            t = k[:, [0, 0, 1]] * e[:, [1, 0, 0]] + k[:, [1, 2, 2]] * e[:, [2, 2, 1]]
        energy += 0.5 * np.sum(t * e * a0)
        t1, t2, t3 = np.hsplit(t, 3)
        g += over_a.T @ (t1 * a0 / aa * a + t3 * b) + over_b.T @ (t2 * a0 / bb * b + t3 * a)
    energy += rubber(lattice, along, x, g) + faces(lattice, along, x, g) + contact(lattice, along, x, g)
    return energy, g


def contact(lattice, along, x, g):
    """Return the energy [J] of points on obstacles; add its gradient to g."""
    place, normal, radius, area, offset, k = np.hsplit(lattice["contact_values"], [3, 6, 7, 8, 9])
    y, curved = along["contact"] @ x - place, radius > 0
    y = y - curved * dot(y, normal) * normal
    touch = offset + radius
    depth = np.maximum(np.where(curved, 0.5 * (touch - dot(y, y) / touch), offset - dot(y, normal)), 0)
    g -= along["contact"].T @ (k * area * depth * np.where(curved, y / touch, normal))
    return 0.5 * np.sum(k * area * depth**2)


def rubber(lattice, along, x, g):
    """Return the energy [J] of rubber membranes at positions x (n, 3) [m]; add its gradient to g."""
    (over_a, over_b), warp, a0 = along["rubber"], along["rubber_warp"], lattice["rubber_rest"][:, None]
    aa, bb = (dot(side @ lattice["positions"], side @ lattice["positions"]) for side in (over_a, over_b))
    c10, c01, c20, c30, v, limit, ka, kb = np.hsplit(lattice["rubber_stiffness"], 8)
    a, b, q, of_limit = over_a @ x, over_b @ x, warp @ x, 1 / np.where(limit > 0, limit, np.inf)
    c11, c22, c12 = (dot(a, a) + dot(q, q) / 12) / aa, (dot(b, b) + dot(q, q) / 12) / bb, dot(a, b) / a0
    trace, area = c11 + c22, c11 * c22 - c12**2
    log = -v / (v + 4 * (c10 + c01)) * np.log(area)
    for _ in range(50):  # Newton's method for the thickness
        theta, i = np.exp(log), trace + np.exp(log) - 3
        f1 = c10 / (1 - i * of_limit) + 2 * c20 * i + 3 * c30 * i**2
        f2 = c10 * of_limit / (1 - i * of_limit) ** 2 + 2 * c20 + 6 * c30 * i
        pull = theta * (f1 + c01 * trace)
        miss = pull - c10 - 2 * c01 + v / 4 * np.log(area * theta)
        log = log - miss / (pull + theta**2 * f2 + v / 4)
    f = np.where(limit > 0, -c10 * limit * np.log1p(-i * of_limit), c10 * i + c20 * i**2 + c30 * i**3)
    volume = np.log(area * theta)
    stored = f + c01 * (area + theta * trace - 3) - (c10 + 2 * c01) * volume + v / 8 * volume**2
    la, lb = (np.sqrt(dot(side, side) + dot(q, q) / 4) for side in (a, b))
    pa, pb = ka * (1 - np.sqrt(aa) / la), kb * (1 - np.sqrt(bb) / lb)
    by_trace, by_area = f1 + c01 * theta, c01 - pull / area
    s, t, st = a0 * (by_trace + by_area * c22) / aa, a0 * (by_trace + by_area * c11) / bb, -2 * by_area * c12
    g += over_a.T @ ((2 * s - pa) * a + st * b) + over_b.T @ ((2 * t - pb) * b + st * a)
    g += warp.T @ (((s + t) / 6 - (pa + pb) / 4) * q)
    return np.sum(a0 * stored - 0.5 * ka * (la - np.sqrt(aa)) ** 2 - 0.5 * kb * (lb - np.sqrt(bb)) ** 2)


def faces(lattice, along, x, g):
    """Return the energy [J] of upright faces in shear; add its gradient to g."""
    (over_a, over_b), k, a0 = along["face"], lattice["face_stiffness"][:, None], lattice["face_rest"][:, None]
    a, b, up = over_a @ x, over_b @ x, over_b @ lattice["positions"]
    long, high = np.sqrt(dot(a, a)), np.sqrt(dot(up, up))
    shear = dot(a, b) / (long * high)
    g += over_a.T @ (a0 * k * shear * (b / (long * high) - shear * a / long**2))
    g += over_b.T @ (a0 * k * shear * a / (long * high))
    return 0.5 * np.sum(k * shear**2 * a0)


def neighbours(along):
    """Return a mask of masses (n, n) with a common spring, and groups of masses without common neighbours."""
    pairs = [
        abs(matrix) if kind in ("link", "contact") else sum(map(abs, matrix))
        for kind, matrix in along.items()
        if not kind.endswith("_warp")
    ]
    near = sum(touched.T @ touched for touched in pairs) > 0
    sharing, groups, remaining = near @ near, [], list(range(len(near)))
    while remaining:
        group = []
        for mass in remaining:
            if not sharing[mass, group].any():
                group.append(mass)
        groups, remaining = [*groups, group], [mass for mass in remaining if mass not in group]
    return near, groups


def stiffness(lattice, along, shared, u, force, h):
    """Return the tangent (3 n, 3 n) [N/m] by differences; the masses of a group are moved together."""
    (near, groups), n = shared, len(u)
    tangent = np.zeros((n, 3, n, 3))
    for group in groups:
        for axis in range(3):
            moved = u.copy()
            moved[group, axis] += h
            ahead = (gradient(lattice, along, moved)[1] - force) / h
            tangent[:, :, group, axis] = near[:, None, group] * ahead[:, :, None]
    return tangent.reshape(3 * n, 3 * n)


def part_of(lattice, along, part, share):
    """Return the lattice with fractions of its natural state and of its contact stiffness."""
    partial = {**lattice, "contact_values": lattice["contact_values"] * np.append(np.ones(9), share)}
    rest = lattice["positions"]
    flat = {"link_rest_length": np.linalg.norm(along["link"] @ rest, axis=1)}
    for kind in ("area", "strain", "coupling"):
        a, b = (side @ rest for side in along[kind])
        flat[f"{kind}_rest"] = np.linalg.norm(np.cross(a, b), axis=1)
        flat[f"{kind}_natural"] = np.hstack([dot(a, a), dot(b, b), dot(a, b)])
    for name, values in flat.items():
        if name in partial:
            partial[name] = values + part * (lattice[name] - values)
    return partial


def equilibrium(lattice, along, steps=1):
    """Return displacements (n, 3) at rest by Newton's method with differences and multipliers of supports.

    The load comes in `steps`, in twice as many where Newton does not converge; then contact stiffens.
    """
    if len(lattice["positions"]) > 1500:
        sys.exit("dense tangents, for 1500 masses at most: write a lattice of a smaller --grid")
    print(f"statics of {len(lattice['positions'])} masses, load in {steps} step(s)", file=sys.stderr)
    shared = neighbours(along)
    n, holds = len(lattice["positions"]), len(lattice["hold_axis"])
    held = np.zeros((holds, n, 3))
    for row, masses in enumerate(lattice["hold_masses"]):
        np.add.at(held, (row, masses, lattice["hold_axis"][row]), 1 / len(masses))
    held = held.reshape(holds, 3 * n)
    u, push, h = np.zeros(3 * n), np.zeros(holds), 1e-7 * lattice["link_rest_length"].max()
    soft, *stiffer = np.geomspace(1e-4, 1, 5) if len(lattice["contact_values"]) else [1.0]  # of stiffness
    for part, share in [*((n / steps, soft) for n in range(1, steps + 1)), *((1, s) for s in stiffer)]:
        now, damping = part_of(lattice, along, part, share), 0.0
        moved = np.inf
        for _ in range(300 if stiffer else 20):
            at = u.reshape(n, 3)
            force = gradient(now, along, at)[1]
            springs = stiffness(now, along, shared, at, force, h)
            damped = springs + damping * np.eye(3 * n)
            tangent = np.block([[damped, held.T], [held, np.zeros((holds, holds))]])
            unbalanced = part * lattice["load"].ravel() - force.ravel() - held.T @ push
            missing = part * lattice["hold_displacement"] - held @ u
            step = np.linalg.solve(tangent, np.concatenate([unbalanced, missing]))
            if stiffer:  # Levenberg's damping, until a step lowers the energy
                before, after = (
                    gradient(now, along, v.reshape(n, 3))[0] - part * lattice["load"].ravel() @ v
                    for v in (u, u + step[: 3 * n])
                )
                if not missing.any() and not after <= before + 1e-9 * abs(before):
                    damping = max(8 * damping, 1e-8 * springs.max())
                    continue
                damping = damping / 4 if damping > 1e-9 * springs.max() else 0.0
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
    if len(lattice["pressure"]) or len(lattice["couple_moment"]):
        sys.exit("this reader solves dead loads only; the folder has pressures or moments")
    along, states, forces = differences(lattice), lattice["state_displacement"], lattice["state_force"]
    found = np.array([gradient(lattice, along, state)[1] for state in states])
    largest = np.abs(found - forces).max() / np.abs(forces).max()
    if lattice["state_name"][-1] != "equilibrium":
        print(f"forces of {len(states)} states off by {largest:.1e}; the folder has no equilibrium")
        sys.exit(not largest < 1e-9)
    u, truth = equilibrium(lattice, along, int([*sys.argv, 1][2])), states[-1]
    off = np.abs(u - truth).max() / np.abs(truth).max()
    print(f"forces of {len(states)} states off by {largest:.1e}, displacements at rest by {off:.1e}")
    if largest < 1e-9 and off > 1e-6:
        print("another equilibrium than the folder's: try more STEPS of the load")
    sys.exit(not (largest < 1e-9 and off < 1e-6))
