"""Scenes with obstacles and their closed forms: the heavy elastica that lies down, by shooting."""

import numpy as np
from cases import sheet
from scipy.integrate import cumulative_trapezoid, solve_ivp, trapezoid
from scipy.optimize import fsolve
from scipy.special import beta

import lumped
from sheetbench.scenes import (
    Box,
    Clamped,
    Cylinder,
    EdgeLoad,
    Hinged,
    Motion,
    Plane,
    Point,
    Scene,
    Sphere,
    Symmetric,
)
from sheetbench.scenes.objects.natural import Natural

GRAVITY, DENSITY, THICKNESS = 9.81, 1e3, 0.005
WEIGHT = DENSITY * THICKNESS * 0.1 * GRAVITY  # N, of the strip
CYLINDER_TIP = -0.36446  # m: elastica over a cylinder by shooting

DROP = 0.03  # m, of a strip that falls on a plane
TABLE = Plane(position=(0.0, 0.0, -DROP - 0.001))
FALLING = sheet(0.2, 0.05, 0.002, 5e6, weight=GRAVITY, obstacles=(TABLE,))
OBSTACLES = {
    "plane": Plane(position=(0, 0, -0.01), normal=(0.1, 0.2, 1)),
    "sphere": Sphere(position=(0.5, 0.05, -0.3), radius=0.28),
    "cylinder": Cylinder(position=(0.4, 0, -0.1), axis=(0.1, 1, 0.05), radius=0.09),
    "box": Box(position=(0.45, 0.04, -0.2), size=(0.3, 0.08, 0.36), radius=0.03),
}
QUARTER = (Symmetric(edge="x0"), Symmetric(edge="y0"))
FALLEN = 1e3 * 0.002 * 0.01 * GRAVITY * DROP  # W H, J


def laid_strip(drop: float, **more: object) -> Scene:
    """Return a strip of B/w = 0.01 L³, clamped at a height above a plane, that lies down on it."""
    young = 0.12 * DENSITY * GRAVITY / THICKNESS**2
    values = {"obstacles": (Plane(position=(0.0, 0.0, -drop - THICKNESS / 2)),)} | more
    return sheet(1.0, 0.1, THICKNESS, young, 0.0, DENSITY, weight=GRAVITY, **values)


def bent_over(at: float = 0.4, radius: float = 0.15 - THICKNESS / 2, height: float = -0.15) -> Scene:
    """Return a weightless strip of B = 1 N m whose end is pulled down, 6 B/L², over a cylinder."""
    pull = EdgeLoad(edge="x1", force_per_length=(0.0, 0.0, -6.0))
    cylinder = Cylinder(position=(at, 0.0, height), axis=(0.0, 1.0, 0.0), radius=radius)
    return sheet(1.0, 0.1, THICKNESS, 12.0 / THICKNESS**3, 0.0, loads=(pull,), obstacles=(cylinder,))


def bent_elastica(at: float, radius: float = 0.15, height: float = -0.15) -> float:
    """Return the cylinder's force [N] on that strip at another place: B θ'' = f_z cos θ + f_x sin θ, with the
    tip's 6 N/m beyond the point of contact and the cylinder's N along its normal before it, by shooting."""

    def bent(fx: float, fz: float, ends: list[float], start: np.ndarray) -> np.ndarray:
        def slope(s: float, y: np.ndarray) -> list[float]:
            return [np.cos(y[2]), -np.sin(y[2]), y[3], fz * np.cos(y[2]) + fx * np.sin(y[2])]

        return solve_ivp(slope, ends, start, rtol=1e-10, atol=1e-12).y[:, -1]

    def missed(z: np.ndarray) -> list[float]:
        s1, force, bend, turned = z
        normal = np.array([np.sin(turned), np.cos(turned)])
        x, y, theta, _ = touch = bent(*(force * normal - [0.0, 6.0]), [0.0, s1], np.array([0, 0, 0, bend]))
        away = np.array([x - at, y - height]) - radius * normal
        return [*away, theta - turned, bent(0.0, -6.0, [s1, 1.0], touch)[3]]

    return float(0.1 * abs(fsolve(missed, [at + 0.03, 14.0, 3.0, 0.3])[1]))


def pressed_loop(gap: float) -> Scene:
    """Return a quarter of a long loop of B = 1 N m that two plates hold flat at a distance (Flaherty and
    Keller, 1973): it starts normal to the symmetry plane, and lies along a plate beyond a turn of π/2."""
    plate = Plane(position=(0.0, 0.0, 0.5 * gap + THICKNESS / 2), normal=(0.0, 0.0, -1.0))
    held = (Clamped(edge="x0", tilt=-np.pi / 2),)
    return sheet(1.0, 0.1, THICKNESS, 12.0 / THICKNESS**3, 0.0, supports=held, obstacles=(plate,))


def loop_force(gap: float) -> float:
    """Return the plate's force [N] on the loop: with B κ²/2 = P cos φ, φ from the plate's normal, half the
    distance is √(B/2P) ∫ √cos φ dφ, so that P = 2 B (I/gap)² a width, I = ½ Β(¾, ½) = 1.19814."""
    return float(0.1 * 2.0 * (0.5 * beta(0.75, 0.5) / gap) ** 2)


def lying_quarter(**more: object) -> Scene:
    """Return a quarter of a sheet that lies on a plane without other supports."""
    values = {"obstacles": (Plane(position=(0.0, 0.0, -0.001)),), "supports": QUARTER} | more
    return sheet(0.2, 0.2, 0.002, 5e6, 0.45, weight=GRAVITY, **values)


def draped_quarter() -> Scene:
    """Return a quarter of a square sheet over a ball."""
    ball = Sphere(position=(0.0, 0.0, -0.0505), radius=0.05)
    return sheet(0.1, 0.1, 0.001, 8e6, weight=GRAVITY, supports=QUARTER, obstacles=(ball,))


def pressed_ball(at: tuple[float, float], rise: float, radius: float = 0.01) -> Scene:
    """Return a hinged sheet with a ball that rises into it from below."""
    lift = Motion(time=(0.0, 1.0), displacement=((0.0, 0.0, 0.0), (0.0, 0.0, rise + 1e-5)))
    ball = Sphere(position=(*at, -radius - 0.001 - 1e-5), radius=radius, motion=lift)
    held = tuple(Hinged(edge=edge) for edge in ("x0", "x1", "y0", "y1"))
    return sheet(0.16, 0.16, 0.002, 2e6, supports=held, obstacles=(ball,))


def curled_sheet() -> Scene:
    """Return a film that curls up by its natural curvature, 5 1/m, on a table: a cradle."""
    held = Point(at=(0.0, 0.0), components=("x", "y")), Point(at=(0.1, 0.0), components=("y",))
    table = Plane(position=(0.0, 0.0, -0.00025))
    curl = Natural(curvature=(5.0, 0.0, 0.0))
    more = {"supports": held, "obstacles": (table,), "natural": curl}
    return sheet(0.1, 0.02, 5e-4, 3e9, 0.35, 1780.0, weight=9.81, **more)


def rocking_frequency() -> float:
    """Return the cradle's frequency [Hz] if the table holds its middle: ω² = g (R − z)/(i² + (e − z)²), R the
    radius at the contact, z the height of the centre of mass, e of the ends, one of which stays above its
    place, i the radius of gyration; the arms are bent by their weight, κ = 5 1/m − M/EI."""
    half, s = 0.05, np.linspace(0.0, 0.05, 4001)
    per = 1780.0 * 5e-4 * 9.81 * 12.0 / (3e9 * 5e-4**3)  # weight over EI, 1/m³
    bend = 5.0 - 0.5 * per * (half - s) ** 2
    turned = cumulative_trapezoid(bend, s, initial=0.0)
    x, z = (cumulative_trapezoid(f(turned), s, initial=0.0) for f in (np.cos, np.sin))
    centre = trapezoid(z, s) / half
    gyration = trapezoid(x**2 + (z - centre) ** 2, s) / half
    arm = gyration + (z[-1] - centre) ** 2
    return float(np.sqrt(9.81 * (1.0 / bend[0] - centre) / arm) / (2.0 * np.pi))


def heavy_elastica(drop: float, per: float = 0.01) -> tuple[float, float, float]:
    """Return the lift-off length [m], the clamp's share of the weight and its M/w [m²] of a strip of length 1
    and of B/w = `per` [m³] above a plane: B θ'' = −(V0 − w s) cos θ, with θ = θ' = y = 0 at the unknown
    lift-off."""
    s0 = (72 * per * drop) ** 0.25

    def ends(z: np.ndarray) -> np.ndarray:
        def slope(s: float, y: np.ndarray) -> list[float]:
            return [y[1], -(z[1] * s0 - s) * np.cos(y[0]) / per, -np.sin(y[0])]

        return solve_ivp(slope, [0, z[2] * s0], [0, z[0] / s0, drop], rtol=1e-10, atol=1e-12).y[:, -1]

    z = fsolve(lambda z: ends(z) * [1, s0, 1 / drop], [6 * drop / s0, 2 / 3, 1.0])
    return z[2] * s0, z[1] * s0, per * z[0] / s0


def on_lattice(scene, grid, grading=0.0, method="consistent", **options):
    springs = lumped.calibrate(scene.sheet, scene.material, grid=grid, grading=grading, method=method)
    return lumped.solve(scene, springs, **options)
