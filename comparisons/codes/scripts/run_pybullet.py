"""Bring the two-layered sheet of sheet.vtk to rest in PyBullet and print the probes as JSON.

    pip install pybullet==3.2.7 numpy
    python run_pybullet.py [SECONDS]

Springs are damped along their length by DAMPING times their stiffness, which PyBullet takes implicitly: steps
then may be as long as twice DAMPING, however stiff the springs, and the sheet creeps to rest. Damping as it
is given in examples (0.1 N·s/m, in all directions) does not stop the sheet within minutes, and requires steps
shorter than a spring's period. All vertices there have equal masses.
"""

import json
import sys
import time
from pathlib import Path

import numpy as np
import pybullet as bullet

STEP, DAMPING = 1e-3, 1e-2  # s
CHECK, AT_REST = 50, 1e-4  # steps between checks; of the largest displacement


def main(seconds=120.0):
    folder = Path(__file__).parent
    sheet = json.loads((folder / "sheet.json").read_text())
    keys, rest, held = sheet["parameters"], np.array(sheet["vertices"]), np.array(sheet["held"])
    mass = float(np.mean(np.array(sheet["masses"])[~held]))
    bullet.connect(bullet.DIRECT)
    bullet.resetSimulation(bullet.RESET_USE_DEFORMABLE_WORLD)
    bullet.setGravity(*sheet["gravity"])
    bullet.setTimeStep(STEP)
    body = bullet.loadSoftBody(
        str(folder / "sheet.vtk"),
        mass=mass * len(rest),
        useMassSpring=1,
        useNeoHookean=0,
        useBendingSprings=0,
        useSelfCollision=0,
        springElasticStiffness=keys["springElasticStiffness"],
        springDampingStiffness=DAMPING * keys["springElasticStiffness"],
        springDampingAllDirections=0,
        collisionMargin=1e-4,
    )
    for vertex in np.flatnonzero(held).tolist():
        bullet.createSoftBodyAnchor(body, vertex, -1, -1)
    status, count, earlier, calm = "step-limit", 0, None, 0
    forced = np.flatnonzero(np.array(sheet["forces"]).any(axis=1))
    if len(forced):
        sys.exit("loadSoftBody takes no forces at single vertices")
    moved = np.zeros_like(rest)
    began = time.process_time()
    while time.process_time() - began < seconds:
        for _ in range(CHECK):
            bullet.stepSimulation()
        count += CHECK
        positions = bullet.getMeshData(body, -1, flags=bullet.MESH_DATA_SIMULATION_MESH)[1]
        moved = np.array(positions) - rest
        if not np.isfinite(moved).all():
            status = "non-finite"
            break
        size = np.abs(moved).max()
        calm = calm + 1 if earlier is not None and np.abs(moved - earlier).max() < AT_REST * size else 0
        earlier = moved
        if calm == 3:
            status = "converged"
            break
    probes = {n: (np.array(p["shares"]) @ moved[p["vertices"]]).tolist() for n, p in sheet["probes"].items()}
    spent = time.process_time() - began
    print(json.dumps({"status": status, "probes": probes, "solve_seconds": spent, "iterations": count}))


if __name__ == "__main__":
    main(*map(float, sys.argv[1:]))
