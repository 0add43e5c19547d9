"""Bring the sheet of sheet.json to rest in Newton's VBD solver and print the probes as JSON.

    pip install newton==1.8.0 warp-lang==1.19.0        # in an environment of its own; it runs on a CPU
    python run_newton.py [SECONDS]

VBD starts each step from free fall and moves back towards equilibrium by blocks; it does not arrive, and the
sheet "rests" too low by about the square of the step, whatever its coefficients. So the sheet is brought to
rest by long steps first and by shorter ones then (STEPS, over the time a wave takes from one vertex to the
next). Velocities are set to zero whenever the kinetic energy has passed a peak.
"""

import json
import sys
import time
from pathlib import Path

import newton
import numpy as np
import warp as wp

STEPS, ITERATIONS = (1.5, 0.75, 0.375), 10
CHECK, AT_REST = 50, 1e-4  # steps between checks; of the largest displacement


def sheet_model(sheet, keys):
    builder = newton.ModelBuilder(up_axis=newton.Axis.Z, gravity=wp.vec3(*sheet["gravity"]))
    for place, held, mass in zip(sheet["vertices"], sheet["held"], sheet["masses"], strict=True):
        builder.add_particle(wp.vec3(*place), wp.vec3(0.0), 0.0 if held else mass, radius=sheet["offset"])
    for corners in sheet["triangles"]:
        builder.add_triangle(*corners, tri_ke=keys["tri_ke"], tri_ka=keys["tri_ka"], tri_kd=0.0)
    normal = {}
    for a, b, c in sheet["triangles"]:
        normal.update({(a, b): c, (b, c): a, (c, a): b})
    for a, b, *_ in sheet["hinges"]:
        factor = sheet["clamp"] if sheet["held"][a] and sheet["held"][b] else 1.0
        builder.add_edge(normal[a, b], normal[b, a], a, b, edge_ke=factor * keys["edge_ke"], edge_kd=0.0)
    for one in sheet["obstacles"]:
        at, kind = wp.vec3(*one["position"]), one["kind"]
        material = newton.ModelBuilder.ShapeConfig(mu=one["friction"])
        along = wp.normalize(wp.vec3(*one.get("normal", one.get("axis", [0.0, 0.0, 1.0]))))
        turned = wp.quat_between_vectors(wp.vec3(0.0, 0.0, 1.0), along)
        if kind == "plane":
            builder.add_shape_plane(plane=(*along, -wp.dot(along, at)), width=0.0, length=0.0, cfg=material)
        elif kind == "sphere":
            builder.add_shape_sphere(-1, xform=wp.transform(at, turned), radius=one["radius"], cfg=material)
        else:
            size = {"radius": one["radius"], "half_height": 50.0 * one["radius"]}
            builder.add_shape_cylinder(-1, xform=wp.transform(at, turned), cfg=material, **size)
    builder.color(include_bending=True)
    return builder.finalize(device="cpu")


def main(seconds=300.0):
    wp.config.quiet = True
    sheet = json.loads((Path(__file__).parent / "sheet.json").read_text())
    keys, rest = sheet["parameters"], np.array(sheet["vertices"])
    model = sheet_model(sheet, keys)
    solver = newton.solvers.SolverVBD(model, iterations=ITERATIONS)
    now, after, control = model.state(), model.state(), model.control()
    sides = rest[np.array([e for e in sheet["edges"] if not (sheet["held"][e[0]] and sheet["held"][e[1]])])]
    spacing = np.linalg.norm(sides[:, 1] - sides[:, 0], axis=1).min()
    areal = np.median(sheet["masses"]) / spacing**2
    steps = [share * spacing / (sheet["stretching"] / areal) ** 0.5 for share in STEPS]
    forces = wp.array(np.array(sheet["forces"], dtype=np.float32), dtype=wp.vec3, device="cpu")
    before, earlier, calm, count, status = 0.0, None, 0, 0, "step-limit"
    began = time.process_time()
    while time.process_time() - began < seconds:
        now.particle_f.assign(forces)
        solver.step(now, after, control, model.collide(now) if sheet["obstacles"] else None, steps[0])
        now, after = after, now
        count += 1
        speed = now.particle_qd.numpy()
        energy = float((speed**2).sum())
        if not np.isfinite(energy):
            status = "non-finite"
            break
        if energy < before:
            now.particle_qd.zero_()
            energy = 0.0
        before = energy
        if count % CHECK == 0:
            moved = now.particle_q.numpy() - rest
            size = np.abs(moved).max()
            calm = calm + 1 if earlier is not None and np.abs(moved - earlier).max() < AT_REST * size else 0
            earlier = moved
            if calm == 2:
                calm, earlier, steps = 0, None, steps[1:]
                if not steps:
                    status = "converged"
                    break
    moved = now.particle_q.numpy() - rest
    probes = {n: (np.array(p["shares"]) @ moved[p["vertices"]]).tolist() for n, p in sheet["probes"].items()}
    spent = time.process_time() - began
    print(json.dumps({"status": status, "probes": probes, "solve_seconds": spent, "iterations": count}))


if __name__ == "__main__":
    main(*map(float, sys.argv[1:]))
