"""Bring the sheet of sheet.obj to rest as Genesis's PBD cloth and print the probes as JSON.

    pip install torch genesis-world==1.4.5
    python run_genesis.py [SECONDS]

Genesis makes a mesh of its own of the one given. Particles that lie on or beyond a held edge are fixed, and
displacements are of the particle nearest to a probe.

A constraint of compliance c is moved once a step of dt without a multiplier, and is at rest as stiff as
1/(c + (w1 + w2) dt²), w = 1/mass; what is said in sheet.json is that stiffness, so the rest is taken off c
here. A hinge is as stiff as s²/(c + W s² dt²), s the sine of its angle: a flat sheet with any bending
compliance does not resist bending. With compliance 0 it is 1/(W dt²) at any angle, times the relaxation, by
which the hinges' stiffness is given here; W is the mean of the mesh's. Keys that begin with "own " are taken
as they are, with Genesis's own iterations. Velocities are set to zero whenever the kinetic energy has passed
a peak.
"""

import json
import sys
import time
from pathlib import Path

import genesis as gs
import numpy as np

CHECK, AT_REST = 50, 1e-4  # steps between checks; of the largest displacement
OWN_STEP = 4e-4  # s, of Genesis's example pbd_cloth.py
TINY = 1e-12  # rad/(N·m): with 0 a flat hinge is 0/0
SHARE = 0.5  # of the step at which a constraint cannot be as stiff as it is to be


def hinges_weight(places, hinges, inverse_mass):
    """The mean over the hinges of W, the sum of w |grad angle|²."""
    a, b, *opposite = places[hinges.T]
    edge = b - a
    long = (edge**2).sum(axis=1)
    first, second, total = 0.0, 0.0, 0.0  # grad at a, at b; the sum of squares at the corners opposite
    for corner in opposite:
        along = ((corner - a) * edge).sum(axis=1) / long
        height = np.sqrt(((corner - a - along[:, None] * edge) ** 2).sum(axis=1))
        first, second, total = (
            first + (1.0 - along) / height,
            second + along / height,
            total + 1.0 / height**2,
        )
    return inverse_mass * float(np.mean(total + first**2 + second**2))


def main(seconds=600.0):
    folder = Path(__file__).parent
    sheet = json.loads((folder / "sheet.json").read_text())
    keys, rest = sheet["parameters"], np.array(sheet["vertices"])
    as_given = {name.split()[1]: value for name, value in keys.items() if name.startswith("own ")}
    gs.init(backend=gs.cpu, logging_level="error", precision="64")
    held = np.array(sheet["held"])
    mass = float(keys["rho"] * np.prod(np.ptp(rest, axis=0)[:2]) / len(rest))
    step = OWN_STEP if as_given else SHARE * (mass / 2.0 * keys["stretch_compliance"]) ** 0.5
    spacing = float(np.linalg.norm(np.diff(rest[np.array(sheet["edges"])], axis=1), axis=2).min())
    size = float(np.ptp(rest, axis=0).max())
    scene = gs.Scene(
        sim_options=gs.options.SimOptions(dt=step, gravity=tuple(sheet["gravity"])),
        pbd_options=gs.options.PBDOptions(
            particle_size=spacing,
            max_stretch_solver_iterations=4 if as_given else 1,
            max_bending_solver_iterations=1,
            lower_bound=tuple(rest.min(axis=0) - size),  # a grid of cells that every step empties
            upper_bound=tuple(rest.max(axis=0) + size),
        ),
        show_viewer=False,
    )
    stretch = keys["stretch_compliance"] - 2.0 * step**2 / mass
    relaxation = (
        hinges_weight(rest, np.array(sheet["hinges"]), 1.0 / mass) * step**2 / keys["bending_compliance"]
    )
    numbers = {"stretch_compliance": stretch, "stretch_relaxation": 1.0}
    numbers |= {"bending_compliance": TINY, "bending_relaxation": relaxation}
    material = gs.materials.PBD.Cloth(**{"rho": keys["rho"], **(as_given or numbers)}, air_resistance=0.0)
    cloth = scene.add_entity(material=material, morph=gs.morphs.Mesh(file=str(folder / "sheet.obj")))
    scene.build()

    def places():
        return np.asarray(cloth.get_particles_pos().cpu(), dtype=float).reshape(-1, 3)

    start = places()
    nearest = np.linalg.norm(start[:, None, :2] - rest[None, :, :2], axis=2).argmin(axis=1)
    cloth.fix_particles(np.flatnonzero(held[nearest]))
    at = {n: np.array(p["shares"]) @ rest[p["vertices"]] for n, p in sheet["probes"].items()}
    own = {n: int(np.linalg.norm(start - place, axis=1).argmin()) for n, place in at.items()}
    status, count, earlier, calm, before = "step-limit", 0, None, 0, 0.0
    scene.step()  # compiles
    started, spent = time.perf_counter(), time.process_time()
    while time.perf_counter() - started < seconds:
        scene.step()
        count += 1
        energy = float((cloth.get_particles_vel() ** 2).sum())
        if not np.isfinite(energy):
            status = "non-finite"
            break
        if energy < before:
            cloth.set_particles_vel(0.0)
            energy = 0.0
        before = energy
        if count % CHECK == 0:
            moved = places() - start
            change = np.inf if earlier is None else np.abs(moved - earlier).max()
            calm = calm + 1 if change < AT_REST * np.abs(moved).max() else 0
            earlier = moved
            if calm == 3:
                status = "converged"
                break
    moved = places() - start
    probes = {n: moved[particle].tolist() for n, particle in own.items()}
    spent = time.process_time() - spent
    print(json.dumps({"status": status, "probes": probes, "solve_seconds": spent, "iterations": count}))


if __name__ == "__main__":
    main(*map(float, sys.argv[1:]))
