"""Sheets that fall on obstacles: energy, step limit, restitution, friction, obstacles that move."""

import re

import numpy as np
import pytest
from cases import calibrated, sheet
from contact_cases import DROP, FALLEN, GRAVITY, pressed_ball
from contact_cases import FALLING as STRIP
from scipy.optimize import brentq

import lumped
from lumped.contact import MOVING
from lumped.dynamics.explicit.step_limit import SAFETY, TOUCHING
from lumped.statics.solver import build_problem
from sheetbench.answers.solution import Status
from sheetbench.scenes import Gravity, Held, Motion, Plane


def run(scene, duration, integrator="auto", grid=(7, 3, 2), **options):
    springs = lumped.calibrate(scene.sheet, scene.material, grid=grid)
    return lumped.simulate(scene, springs, duration, integrator=integrator, **options)


def drift(history):
    return float(np.abs(history.balance - history.balance[0]).max()) / FALLEN


# ten touches, seen by the millisecond, on a fine and a coarse grid; the conserving steps keep energy to their
# iteration's tolerance, at any length
@pytest.mark.sweep(2)
@pytest.mark.parametrize(
    ("integrator", "duration", "options", "within"),
    [
        ("auto", 0.35, {"grid": (11, 5, 2), "every": 1e-3}, 5e-3),
        ("auto", 0.5, {"every": 1e-3}, 5e-3),
        ("midpoint", 0.2, {"step": 1e-3}, 1e-8),
        ("esdirk", 0.2, {}, 5e-3),
    ],
)
def test_energy_of_a_strip_that_bounces(integrator, duration, options, within):
    history = run(STRIP, duration, integrator, **options)
    assert history.status is Status.CONVERGED
    touches = np.diff((history.reactions["obstacle 1"][:, 2] > 0.0).astype(int)) == 1
    assert integrator != "auto" or touches.sum() >= 10
    assert drift(history) < within
    tip = history.probes["P4"][:, 2]
    assert -1.3 * 0.002 < tip.min() + DROP < 0.1 * DROP  # a sample may miss the touch itself
    assert history.reactions["obstacle 1"][:, 2].max() > 0.0


NOTCH = {"shape": {"rectangle": {"x": (0.12, 0.2), "y": (0.02, 0.05)}}}  # with masses in it, of none


def test_a_dashpot_that_touches_a_held_edge_alone_does_not_shorten_steps():
    limits = []
    for tau in (0.0, 0.3):
        place = (0.0, 0.0, -0.001 * np.hypot(1.0, 0.05))
        plane = Plane(position=place, normal=(0.05, 0.0, 1.0), contact_damping=tau)
        history = run(STRIP.replace(obstacles=(plane,)), 1e-3, "verlet")
        limits.append(history.settings["largest_step"])
    assert limits[0] == limits[1]


@pytest.mark.parametrize("cutouts", [(), (NOTCH,)])
def test_explicit_steps_are_hardly_shorter(cutouts):
    scene = STRIP.replace(cutouts=cutouts)
    springs = calibrated(scene, (7, 3))
    both = scene.replace(obstacles=()), scene
    free, touching = (lumped.simulate(one, springs, 0.01, integrator="verlet") for one in both)
    ratio = free.settings["largest_step"] / touching.settings["largest_step"]
    assert 1.0 <= ratio < np.sqrt(1.0 + MOVING) + 1e-6
    assert ratio * SAFETY / TOUCHING <= 1.2


ROD = {
    "kind": "chain",
    "edge": "x1",
    "segments": 4,
    "bending_stiffness": 1e-4,
    "line_density": 0.02,
    "radius": 0.002,
}


@pytest.mark.parametrize(
    ("more", "integrator", "why"),
    [
        ({}, "verlet", "with obstacles"),
        ({"damping_time": 1e-4}, "verlet", "with obstacles"),
        ({"damping_time": 8e-3}, "esdirk", "as dampers make explicit steps [0-9]+ times shorter"),
        ({"actuators": [ROD]}, "generalised-alpha", "with chains"),
    ],
)
def test_auto_takes_the_steps_of_least_work(more, integrator, why):
    """Implicit ones where stiffness-proportional dampers shorten explicit steps more than four times."""
    material = {name: more[name] for name in more if name == "damping_time"}
    scene = STRIP.replace(material=STRIP.material.replace(**material), actuators=more.get("actuators", []))
    history = run(scene, 1e-3, **({"step": 1e-4} if integrator == "generalised-alpha" else {}))
    assert history.status is Status.CONVERGED and history.integrator == integrator
    assert re.fullmatch(f"least time at equal error, {why}", history.settings["integrator_reason"])


def block(obstacle, slope=0.0, **more):
    """A stiff small sheet that nothing but an obstacle stops; gravity at a slope."""
    gravity = Gravity(acceleration=(GRAVITY * np.sin(slope), 0.0, -GRAVITY * np.cos(slope)))
    return sheet(0.02, 0.02, 0.002, 5e6, held="", gravity=gravity, obstacles=(obstacle,), **more)


@pytest.mark.nightly
def test_restitution_of_the_dashpot():
    tau, drop = 0.5, 0.02
    fall = block(Plane(position=(0.0, 0.0, -drop - 0.001), contact_damping=tau))
    history = run(fall, 0.12, "verlet", grid=(3, 3, 2), every=1e-4)
    height = history.probes["P1"][:, 2] + drop
    speed = np.sqrt(2 * GRAVITY * drop)
    first = int(np.argmax(height <= 0.0))
    rebound = height[first:][: int(0.5 * first) * 2]
    peak = rebound[int(np.argmax(rebound > 0.0)) :].max()

    def closing(e):
        before = speed / tau - np.log1p(tau * speed) / tau**2
        return before + e * speed / tau + np.log1p(-tau * e * speed) / tau**2

    restitution = brentq(closing, 1e-6, 1.0)
    assert restitution == pytest.approx(1 - 2 * tau * speed / 3, abs=0.05)
    # its weight adds to what the dashpot takes, by 4 g τ v̄ d/v² of the height for a contact d deep
    assert np.sqrt(peak / drop) == pytest.approx(restitution, rel=0.015)
    corner = history.probes["P4"][:, 2] + drop
    assert np.abs(corner - height).max() < 1e-9 * drop  # it lands flat, and leaves flat
    fallen = 1e3 * 0.002 * 4e-4 * GRAVITY * drop
    assert drift(history) * FALLEN < 5e-3 * fallen
    # after it has left again the balance is off in h⁴ only, ω² = 0.065 ω_max² of contact, h = 1.6/ω_max
    assert abs(history.balance[-1] - history.balance[0]) < (MOVING * 1.6**2) ** 2 / 12 * fallen


def test_friction_slows_a_slide():
    slope, friction, duration = 0.5, 0.3, 0.05
    slide = block(Plane(position=(0.0, 0.0, -0.001), friction=friction), slope)
    history = run(slide, duration, grid=(3, 3, 2))
    gone = 0.5 * GRAVITY * (np.sin(slope) - friction * np.cos(slope)) * duration**2
    assert history.probes["P1"][-1, 0] == pytest.approx(gone, rel=0.02)
    assert "sticking points creep" in history.message
    assert history.energies["dissipated"][-1] > 0.0


@pytest.mark.sweep
@pytest.mark.parametrize("integrator", ["auto", "midpoint", "esdirk"])
def test_work_of_a_lifting_plane_is_the_gain_of_energy(integrator):
    """A hanging strip that a plane lifts gains what the plane gives."""
    lift = Motion(time=(0.0, 0.1), displacement=((0.0, 0.0, 0.0), (0.0, 0.0, 0.02)))
    pressed = STRIP.replace(
        gravity=None,
        obstacles=(Plane(position=(0.0, 0.0, -0.002), motion=lift),),
        supports=(Held(edge="x0", components=("x", "y", "z")),),
    )
    options = {"step": 5e-4} if integrator == "midpoint" else {}
    history = run(pressed, 0.1, integrator, **options)
    work = history.energies["work"][-1]
    assert work > 0.0
    gained = history.energies["kinetic"][-1] + history.energies["elastic"][-1]
    assert gained == pytest.approx(work, rel=5e-3)


@pytest.mark.nightly
def test_probes_in_motion_are_on_cubics_over_a_ball():
    """A third short of the place at rest, by the give of contact in motion; on cells still more."""
    at, rise = (0.0733, 0.0867), 1.5e-3
    still = pressed_ball(at, rise)
    lift = still.obstacles[0].motion.replace(time=(0.0, 0.05))
    damped = still.material.replace(damping_rate=60.0)
    scene = still.replace(
        obstacles=(still.obstacles[0].replace(motion=lift),), material=damped, probes={"P": at}
    )
    springs = lumped.calibrate(scene.sheet, scene.material, grid=(9, 9, 2))
    history = lumped.simulate(scene, springs, 0.25, every=0.0125, frames=20)
    lattice = build_problem(scene, springs).assembly.lattice
    on_cells = lumped.MidSurface(lattice, np.array([at]), order=1).of(history.extra["frames"][-1])[0, 2]
    assert history.probes["P"][-1, 2] == pytest.approx(1.01e-3, rel=0.01)
    assert on_cells == pytest.approx(0.96e-3, rel=0.01)
