"""Sheets that bend by themselves beside closed forms and each other: the figures of docs/natural.md.

    python benchmarks/natural.py [growth arc cantilever grown heated past stretched band dome bilayer]

Each row has the lattice on 9, 17 and 33 masses across (of an arc along), the order of its last two errors
where there is a truth, the shell (of growth the solid too), and the truth. `bilayer` takes minutes, the
others one together.
"""

import argparse
from collections.abc import Callable
from typing import Any

import numpy as np

import fem_reference
import lumped
import sheetbench
from sheetbench.scenes import (
    Clamped,
    Gravity,
    Held,
    Hinged,
    Material,
    Patch,
    Point,
    Scene,
    Sheet,
    Symmetric,
    load,
)
from sheetbench.scenes.meaning.natural_state import sheet_at_rest
from sheetbench.scenes.objects.natural import Natural

MATERIAL = Material(young=1e6, poisson=0.3, density=1e3)
ONE, HINGES = (Clamped(edge="x0"),), tuple(Hinged(edge=edge) for edge in ("x0", "x1", "y0", "y1"))
CLAMPS = tuple(Clamped(edge=edge) for edge in ("x0", "x1", "y0", "y1"))
How = int | str  # masses across, or a reference


def scene_of(size: tuple[float, float, float], supports: Any, weight: float = 0.0, **own: Any) -> Scene:
    """Return a sheet of this size [m] with a probe in the middle of its edge x1; weight: of g [m/s²]."""
    return Scene(
        name="natural",
        sheet=Sheet(length_x=size[0], length_y=size[1], thickness=size[2]),
        material=MATERIAL,
        supports=supports,
        gravity=Gravity(acceleration=(0.0, 0.0, -weight)) if weight else None,
        probes={"tip": [size[0], size[1] / 2.0]},
        **own,
    )


def springs(scene: Scene, across: int) -> lumped.Calibration:
    """Return springs of square cells for the sheet as it is without stress."""
    grid = (round((across - 1) * scene.sheet.length_x / scene.sheet.length_y) + 1, across, 2)
    cells = lumped.sections_of(scene, grid)
    return lumped.calibrate(sheet_at_rest(scene), scene.material, grid=grid, cells=cells)


def solved(scene: Scene, how: How, elements: int = 8, **options: Any) -> Any:
    """Return a model's equilibrium."""
    if isinstance(how, int):
        found = lumped.solve(scene, springs(scene, how), **options)
    else:
        found = fem_reference.solve(scene, model=how, elements=elements, **options)
    assert found.succeeded, found.message
    return found


def at(scene: Scene, how: How, point: tuple[float, float] | None = None) -> np.ndarray:
    """Return the displacement (3,) [m] of a point or of the probe."""
    points = scene.probe_points() if point is None else np.array([point])
    return np.asarray(solved(scene, how).displacement(points)[0])


def said(
    name: str,
    value: Callable[[How], float],
    truth: float | None,
    references: tuple[str, ...] = ("shell",),
    across: tuple[int, ...] = (9, 17, 33),
) -> None:
    """Print a row."""
    found = [value(n) for n in across]
    order = ""
    if truth is not None and abs(found[2]) > 1e-20:
        off = np.abs(np.array(found[1:]) - truth)
        order = f"order {np.log2(off[0] / off[1]):.2f}"
    others = ", ".join(f"{one} {value(one):.5g}" for one in references)
    figures = "".join(f"{x:12.5g}" for x in found)
    print(
        f"{name:<52}{figures}  {order:<12}{others}; truth {'-' if truth is None else f'{truth:.5g}'}",
        flush=True,
    )


def growth() -> None:
    rims = [
        Symmetric(edge="x0"),
        Symmetric(edge="y0"),
        *(Held(edge=e, components=("z",)) for e in ("x1", "y1")),
    ]
    of = scene_of((0.2, 0.1, 0.004), tuple(rims), natural=Natural((0.08, -0.03, 0.0)))
    said(
        "free growth: energy [J]",
        lambda how: sum(solved(of, how, 4).energies.values()),
        0.0,
        ("shell", "solid"),
    )


def arc() -> None:
    for turns in (0.25, 0.9):
        k = 2.0 * np.pi * turns / 0.2
        end = np.array([np.sin(0.2 * k) / k - 0.2, 0.0, (1.0 - np.cos(0.2 * k)) / k])
        of = scene_of((0.2, 0.1, 0.002), ONE, natural=Natural(curvature=(k, 0.0, 0.0)))

        def off(how: How, of: Scene = of, end: np.ndarray = end) -> float:
            return float(np.linalg.norm(at(of, how) - end)) / 0.2

        said(f"arc of {turns:g} turns: tip off over length", off, 0.0, across=(5, 9, 17))


def cantilever() -> None:
    for k, exact in (((0.25, 0.25, 0.0), (5.0997, 5.3762)), ((0.25, 0.1, 0.0), (5.1621, 5.2661))):
        of = scene_of((0.2, 0.1, 0.0005), ONE, natural=Natural(curvature=k))
        for place, y, truth in zip(("tip", "corner"), (0.05, 0.1), exact, strict=True):

            def rise(how: How, of: Scene = of, y: float = y) -> float:
                return 1e3 * float(at(of, how, (0.2, y))[2])

            said(f"k0 = {k[0]:g}, {k[1]:g}: uz of the {place} [mm], C3D20R", rise, truth)


def grown() -> None:
    own = Natural((0.1, 0.0, 0.0))
    half = Patch(shape={"rectangle": {"x": (0.0, 0.1), "y": (0.0, 0.05)}}, natural=own)
    for name, more, truth in (("sheet", {"natural": own}, 1.1**3), ("half", {"patches": (half,)}, None)):

        def ratio(how: How, more: Any = more) -> float:
            bent, flat = (at(scene_of((0.2, 0.05, 0.002), ONE, 1e-3, **each), how)[2] for each in (more, {}))
            return float(bent / flat)

        said(f"{name} grown by 10 %: deflection over ungrown", ratio, truth)


def plate(times: float, held: Any) -> Scene:
    """Return a square heated to so many times the strain at which Kirchhoff's hinged plate buckles."""
    strain = times * np.pi**2 * 0.002**2 / (6.0 * 1.3 * 0.2**2)
    return scene_of((0.2, 0.2, 0.002), held, natural=Natural((strain, strain, 0.0)))


def heated() -> None:
    for name, times, held in (("hinged", 1.0, HINGES), ("clamped", 5.304 / 2.0, CLAMPS)):
        of = plate(times, held)

        def buckles(how: How, of: Scene = of) -> float:
            lattice = isinstance(how, int)
            found = lumped.buckling(of, springs(of, how)) if lattice else fem_reference.buckling(of, how, 16)
            return float(found.load_factors[0])

        said(f"heated, {name}: buckles over Kirchhoff's", buckles, None)


def past() -> None:
    for times in (2.0, 5.0):
        of = plate(times, HINGES)
        said(
            f"{times:g} times past buckling: w/h",
            lambda how, of=of: abs(float(at(of, how, (0.1, 0.1))[2])) / 0.002,
            None,
        )


def stretched() -> None:
    h, tension, q = 2.5e-4, 0.05, 2.0 * np.pi**2 / 0.04
    exact = np.sqrt((1e6 * h**3 / 10.92 * q**2 + tension * q) / (1e3 * h)) / (2.0 * np.pi)
    of = scene_of((0.2, 0.2, h), HINGES, natural=Natural(pretension=(tension, tension)))

    def off(how: How) -> float:
        if isinstance(how, int):
            found = lumped.modes(of, springs(of, how), 1, about="deformed").frequencies[0]
        else:
            found = fem_reference.modes(of, how, 8, 1, about="deformed").frequencies[0]
        return 100.0 * float(found / exact - 1.0)

    said("stretched square: frequency off [%]", off, 0.0)


def band() -> None:
    shape = {"rectangle": {"x": (0.05, 0.1), "y": (0.0, 0.1)}}
    muscle = Patch(shape=shape, natural=Natural(curvature=(20.0, 0.0, 0.0)))
    of = scene_of((0.2, 0.1, 0.002), ONE, 0.981, patches=(muscle,))
    shell = at(of, "shell")

    def vector(how: How) -> float:
        return 100.0 * float(np.linalg.norm(at(of, how) - shell) / np.linalg.norm(shell))

    def printed(how: How) -> float:
        options = {"lumped": f"{2 * how - 1}x{how}"} if isinstance(how, int) else {"reference": how}
        found = sheetbench.compare(of, elements=8, **options)
        return 100.0 * float(found.error(found.solutions[0]) or 0.0)

    said("band under weight off the shell [%], as compare's", printed, 0.0, ())
    said("band under weight off the shell [%], as a vector", vector, 0.0, ("solid",))


def dome() -> None:
    h = 0.002
    limit = 2.0 * h / (0.2**2 * np.sqrt(12.0 * 1.3 * 3.891e-4)) / 1.3
    rims = (Symmetric(edge="x0"), Symmetric(edge="y0"), Point(at=(0.0, 0.0), components=("z",)))
    of = scene_of((0.1, 0.1, h), rims, natural=Natural(curvature=(1.5 * limit, 1.5 * limit, 0.0)))
    said("free dome: snaps at, over uniform curvatures", lambda how: 1.5 * solved(of, how, 4).snaps[0], None)


def bilayer() -> None:
    of, middle = load("bistable-bilayer"), np.array([[0.05, 0.05]])

    def snaps(how: How) -> float:  # the largest of steps of 1.6 mN at which it has not
        force, step, near = 0.0, 0.2, None
        while step > 1.5e-3:
            ahead = 0.0 if near is None else force + step
            push = of.loads[0].replace(force=(0.0, 0.0, -ahead), history=None)
            found = solved(of.replace(loads=(push,)), how, near=near)
            if found.displacement(middle)[0, 2] > 0.0:
                shape = found.mesh.point_data["displacement"] if isinstance(how, int) else None
                force, near = (
                    ahead,
                    shape if shape is not None else lambda at, of=found: of.displacement(at[:, :2]),
                )
            else:  # upside down
                step /= 2.0
        return force

    said("bistable-bilayer: force [N] at which it snaps", snaps, None)


PARTS = {
    part.__name__: part
    for part in (growth, arc, cantilever, grown, heated, past, stretched, band, dome, bilayer)
}


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("parts", nargs="*", choices=[[], *PARTS], help="unless given, all")
    for name in parser.parse_args().parts or PARTS:
        PARTS[name]()
