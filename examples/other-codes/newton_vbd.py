"""Test 1 of Habibi et al. in Newton's VBD solver, with the coefficients that `sheetbench homogenise` gives.

    pip install newton==1.8.0 warp-lang==1.19.0        # in an environment of its own; it runs on a CPU
    sheetbench homogenise alternate-diagonals --json > cell.json
    python newton_vbd.py cell.json alternate 8         # [edge_ke in place of the file's]

The clamps are a row of fixed particles beyond the edge, so that the hinges along it hold the slope;
velocities are damped at 25/s until the sheet rests. VBD moves towards each step's equilibrium by blocks.
With steps much longer than the membrane's own period it does not arrive: at 1/30 s the sheet "rests" ten
times too low, with any coefficients. Here the step is 0.2 ms. Printed: z of the middle of a free side and
of the corner, where a converged shell has -6.10 and -13.50 mm.
"""

import json
import sys

import newton
import numpy as np
import warp as wp

SIDE, THICKNESS, DENSITY = 0.188, 0.003, 1678.0
STEP, STEPS, ITERATIONS, DAMPING = 2e-4, 3000, 20, 25.0


def sheet(cells, alternate, tri_ke, tri_ka, edge_ke):
    """The model and the numbers of its particles, [-1 … cells] along x and y; what is below 1 is fixed."""
    size = SIDE / cells
    builder = newton.ModelBuilder(up_axis=newton.Axis.Z, gravity=wp.vec3(0.0, 0.0, -9.81))
    number = {}
    for i in range(-1, cells + 1):
        for j in range(-1, cells + 1):
            share = (0.5 if i == cells else 1.0) * (0.5 if j == cells else 1.0)
            mass = 0.0 if i <= 0 or j <= 0 else DENSITY * THICKNESS * size**2 * share
            place = wp.vec3(i * size, j * size, 0.0)
            number[i, j] = builder.add_particle(place, wp.vec3(0.0), mass)
    opposite = {}
    for i in range(-1, cells):
        for j in range(-1, cells):
            a, b, c, d = number[i, j], number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]
            both = ((a, b, d), (b, c, d)) if alternate and (i + j) % 2 else ((a, b, c), (a, c, d))
            for corners in both:
                builder.add_triangle(*corners, tri_ke=tri_ke, tri_ka=tri_ka, tri_kd=0.0)
                for k in range(3):
                    first, second, third = (corners[(k + n) % 3] for n in range(3))
                    edge = opposite.setdefault(frozenset((first, second)), [first, second])
                    edge.append(third)
    for first, second, *others in opposite.values():
        if len(others) == 2:
            builder.add_edge(*others, first, second, edge_ke=edge_ke, edge_kd=0.0)
    builder.color(include_bending=True)
    return builder.finalize(device="cpu"), number


def main(file, mesh, cells, edge_ke=None):
    with open(file) as opened:
        found = json.load(opened)["coefficients"]
    values = {
        "tri_ke": found["mu_h"],
        "tri_ka": found["lambda_h"] + found["mu_h"],
        "edge_ke": float(edge_ke or found["hinge"]),
    }
    cells = int(cells)
    model, number = sheet(cells, mesh == "alternate", **values)
    solver = newton.solvers.SolverVBD(model, iterations=ITERATIONS)
    now, after, control = model.state(), model.state(), model.control()
    for step in range(STEPS):
        solver.step(now, after, control, None, STEP)
        now, after = after, now
        now.particle_qd.assign(now.particle_qd.numpy() * np.exp(-DAMPING * STEP))
        if (step + 1) % 500 == 0:
            z = 1e3 * now.particle_q.numpy()[:, 2]
            ends = z[number[cells // 2, cells]], z[number[cells, cells]]
            print(f"{(step + 1) * STEP:.1f} s: side {ends[0]:.2f} mm, corner {ends[1]:.2f} mm", flush=True)


if __name__ == "__main__":
    wp.config.quiet = True
    main(*sys.argv[1:])
