"""Let the sheet of sheet.obj fall to rest as Genesis's PBD cloth and print the probes as JSON.

    pip install genesis-world==0.4.6 torch
    python run_genesis.py [SECONDS]

Genesis makes a mesh of its own of the one given. Particles that lie on or beyond a held edge are fixed, and
displacements are of the particle nearest to a probe. Iterations are one and not relaxed, so that a compliance
is what it says wherever it is larger than (w1 + w2) dt².
"""

import json
import sys
import time
from pathlib import Path

import genesis as gs
import numpy as np

STEP, AT_REST, CHECK = 1e-3, 1e-3, 100


def main(seconds=600.0):
    folder = Path(__file__).parent
    sheet = json.loads((folder / "sheet.json").read_text())
    keys, rest = sheet["parameters"], np.array(sheet["vertices"])
    gs.init(backend=gs.cpu, logging_level="error", precision="64")
    spacing = float(np.linalg.norm(np.diff(rest[np.array(sheet["edges"])], axis=1), axis=2).min())
    scene = gs.Scene(
        sim_options=gs.options.SimOptions(dt=STEP, gravity=tuple(sheet["gravity"])),
        pbd_options=gs.options.PBDOptions(
            particle_size=spacing,
            max_stretch_solver_iterations=1,
            max_bending_solver_iterations=1,
            lower_bound=(-10.0, -10.0, -10.0),
            upper_bound=(10.0, 10.0, 10.0),
        ),
        show_viewer=False,
    )
    material = gs.materials.PBD.Cloth(
        **keys, stretch_relaxation=1.0, bending_relaxation=1.0, air_resistance=0.0
    )
    cloth = scene.add_entity(material=material, morph=gs.morphs.Mesh(file=str(folder / "sheet.obj")))
    scene.build()

    def places():
        return np.asarray(cloth.get_particles_pos().cpu(), dtype=float).reshape(-1, 3)

    start, held = places(), np.array(sheet["held"])
    nearest = np.linalg.norm(start[:, None, :2] - rest[None, :, :2], axis=2).argmin(axis=1)
    for particle in np.flatnonzero(held[nearest]).tolist():
        cloth.fix_particle(particle, 0)
    at = {n: np.array(p["shares"]) @ rest[p["vertices"]] for n, p in sheet["probes"].items()}
    own = {n: int(np.linalg.norm(start - place, axis=1).argmin()) for n, place in at.items()}
    status, count, earlier, started = "step-limit", 0, None, time.perf_counter()
    while time.perf_counter() - started < seconds:
        scene.step()
        count += 1
        if count % CHECK == 0:
            moved = places() - start
            if not np.isfinite(moved).all():
                status = "non-finite"
                break
            if earlier is not None and np.abs(moved - earlier).max() < AT_REST * np.abs(moved).max():
                status = "converged"
                break
            earlier = moved
    moved = places() - start
    probes = {n: moved[particle].tolist() for n, particle in own.items()}
    spent = time.perf_counter() - started
    print(json.dumps({"status": status, "probes": probes, "solve_seconds": spent, "iterations": count}))


if __name__ == "__main__":
    main(*map(float, sys.argv[1:]))
