"""Bring the sheet of sheet.obj to rest as Genesis's PBD cloth and print the probes as JSON.

    pip install torch genesis-world==1.4.5
    python run_genesis.py [SECONDS]

A constraint of compliance c is moved once a step of dt without a multiplier, and is at rest as stiff as 1/(c
+ (w1 + w2) dt²), w = 1/mass, 0 of held vertices; sheet.json has that stiffness, so the rest is taken off c
here. A hinge is as stiff as s²/(c + W dt² s²), s the sine of its angle, W = Σ w |grad angle|²: a flat sheet
with any bending compliance does not resist bending. At compliance 0 it is r/(W dt²), r the relaxation, by
which a hinge's stiffness is given here. W is less next to a clamp, whose vertices have w = 0: with one r for
all, the material's, hinges there are up to six times as stiff. So masses, compliances and relaxations are put
into the solver's own fields, for every vertex, side and hinge, and the mesh is kept, which Genesis would
replace by one of its own.

Keys that begin with "own " are taken as they are, with Genesis's own mesh, masses and iterations; then the
vertices nearest to the held ones of the given mesh are held, and a probe has the displacement of the vertex
next to it. Velocities are set to zero whenever the mean kinetic energy of some steps has passed a peak. The
sheet rests when it then hardly starts again: its way is compared with the way under the load alone in that
time, for steps are so short that it moves little between two checks, wherever it is.
"""

import json
import sys
import time
from pathlib import Path

import genesis as gs
import numpy as np
from genesis.engine.mesh import Mesh

CHECK, AT_REST = 50, 2e-3  # steps between checks; acceleration of what was stopped, of that by the load alone
OWN_STEP = 4e-4  # s, of Genesis's example pbd_cloth.py
TINY = 1e-12  # rad/(N·m): with 0 a flat hinge is 0/0
APART = 0.9  # of the shortest side: as near, particles touch, and stick to each other by friction
PASSED = 0.9  # of a peak of the kinetic energy, below which it is behind
SHARE = 0.5  # of the step at which a constraint cannot be as stiff as it is to be


def hinge_weights(places, hinges, w):
    """Return the weight W of every hinge."""
    a, b, *opposite = places[hinges.T]
    edge = b - a
    long = (edge**2).sum(axis=1)
    first, second, total = 0.0, 0.0, 0.0  # grad at a, at b; the weighted squares at the corners opposite
    for number, corner in zip(hinges.T[2:], opposite, strict=True):
        along = ((corner - a) * edge).sum(axis=1) / long
        height = np.sqrt(((corner - a - along[:, None] * edge) ** 2).sum(axis=1))
        first, second, total = (
            first + (1.0 - along) / height,
            second + along / height,
            total + w[number] / height**2,
        )
    return total + w[hinges[:, 0]] * first**2 + w[hinges[:, 1]] * second**2


def main(seconds=600.0):
    folder = Path(__file__).parent
    sheet = json.loads((folder / "sheet.json").read_text())
    keys, rest, held = sheet["parameters"], np.array(sheet["vertices"]), np.array(sheet["held"])
    forces, masses = np.array(sheet["forces"]), np.array(sheet["masses"])
    edges = np.array(sheet["edges"])
    as_given = {name.split()[1]: value for name, value in keys.items() if name.startswith("own ")}
    gs.init(backend=gs.cpu, logging_level="error", precision="64")
    w = np.where(held, 0.0, 1.0 / masses)
    step = SHARE * (keys["stretch_compliance"] / w[edges].sum(axis=1).max()) ** 0.5
    if as_given:
        step = OWN_STEP
    else:
        Mesh.remesh = lambda mesh, **_: None
    size = float(np.ptp(rest, axis=0).max())
    scene = gs.Scene(
        sim_options=gs.options.SimOptions(dt=step, gravity=tuple(sheet["gravity"])),
        pbd_options=gs.options.PBDOptions(
            particle_size=(1.0 if as_given else APART)
            * float(np.linalg.norm(np.diff(rest[edges], axis=1), axis=2).min()),
            max_stretch_solver_iterations=4 if as_given else 1,
            max_bending_solver_iterations=1,
            lower_bound=tuple(rest.min(axis=0) - size),  # a grid of cells that every step empties
            upper_bound=tuple(rest.max(axis=0) + size),
        ),
        show_viewer=False,
    )
    numbers = {"stretch_relaxation": 1.0, "bending_compliance": TINY, **as_given}
    material = gs.materials.PBD.Cloth(rho=keys["rho"], **numbers, air_resistance=0.0)
    cloth = scene.add_entity(material=material, morph=gs.morphs.Mesh(file=str(folder / "sheet.obj")))
    scene.build()

    def places():
        return np.asarray(cloth.get_particles_pos().cpu(), dtype=float).reshape(-1, 3)

    start = places()
    nearest = np.linalg.norm(start[:, None, :2] - rest[None, :, :2], axis=2).argmin(axis=1)
    fixed = held[nearest]
    cloth.fix_particles(np.flatnonzero(fixed))
    if as_given:
        if forces.any():
            sys.exit("no forces on a mesh of Genesis's own")
    else:
        solver, w, masses, forces = scene.sim.pbd_solver, w[nearest], masses[nearest], forces[nearest]
        hinges = cloth._inner_edges
        stiffness = (
            np.where(fixed[hinges[:, :2]].all(axis=1), sheet["clamp"], 1.0) / keys["bending_compliance"]
        )
        solver.particles_info.mass.from_numpy(masses)
        compliance = keys["stretch_compliance"] - w[cloth._edges].sum(axis=1) * step**2
        solver.edges_info.stretch_compliance.from_numpy(compliance)
        relaxation = stiffness * hinge_weights(start, hinges, w) * step**2
        solver.inner_edges_info.bending_relaxation.from_numpy(relaxation)
    at = {n: np.array(p["shares"]) @ rest[p["vertices"]] for n, p in sheet["probes"].items()}
    vertex_of = np.full(len(rest), -1)
    vertex_of[nearest] = np.arange(len(start))
    shares = {n: (vertex_of[p["vertices"]], np.array(p["shares"])) for n, p in sheet["probes"].items()}
    if as_given:
        shares = {n: ([np.linalg.norm(start - x, axis=1).argmin()], np.ones(1)) for n, x in at.items()}
    load = np.linalg.norm((masses[:, None] * sheet["gravity"] + forces).sum(axis=0)) / masses.sum()
    status, count, since, calm, energies, peak = "step-limit", 0, 0, 0, [], 0.0
    scene.step()  # compiles
    stopped = places()
    began = time.process_time()
    while time.process_time() - began < seconds:
        speed = np.asarray(cloth.get_particles_vel().cpu(), dtype=float).reshape(-1, 3)
        if forces.any():
            cloth.set_particles_vel(speed + step * w[:, None] * forces)
        scene.step()
        count, since = count + 1, since + 1
        energies.append(float((speed**2).sum()))
        if not np.isfinite(energies[-1]):
            status = "non-finite"
            break
        if count % CHECK:
            continue
        now = places()
        calm = calm + 1 if np.abs(now - stopped).max() < AT_REST * load * (since * step) ** 2 / 2.0 else 0
        if calm == 3:
            status = "converged"
            break
        energy, energies = float(np.mean(energies)), []
        peak = max(peak, energy)
        if energy < PASSED * peak:
            cloth.set_particles_vel(0.0)
            peak, since, stopped = 0.0, 0, now
    moved = places() - start
    probes = {n: (by @ moved[vertices]).tolist() for n, (vertices, by) in shares.items()}
    spent = time.process_time() - began
    print(json.dumps({"status": status, "probes": probes, "solve_seconds": spent, "iterations": count}))


if __name__ == "__main__":
    main(*map(float, sys.argv[1:]))
