"""A lattice as files for other codes: its springs, masses, supports and loads, and a program that reads them.

The tables and arrays can be read by any program; `CODES` have a file of their own beside them. A README of a
page has the formulas of force and energy.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.codes.files import script, to_sofa
from comparisons.codes.fmu import fmu_files
from comparisons.codes.onefile import program
from comparisons.codes.tables import NAMES, arrays, contacts, natural, tables
from comparisons.pictures.array_files import write_mat, write_npz
from comparisons.sweep.folder import Folder
from sheetbench.answers.escape import markdown
from sheetbench.answers.files import to_json, write_text
from sheetbench.answers.report import Write
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.composition import require_flat_at_rest
from sheetbench.scenes.meaning.distances import require_no_obstacles
from sheetbench.scenes.meaning.words import in_words
from sheetbench.scenes.objects.obstacles import Box
from sheetbench.sources import version

if TYPE_CHECKING:
    from lumped import Calibration, Description


OWN = ("material", "layer", "patch", "cutout")  # lines of a scene in words
MISSING = "Masses beyond the outline and in cutouts are left out; `i`, `j`, `k` number lines and layers.\n"
NATURAL = """
The sheet is not flat and free of stress at rest; all that is without stress is in the files. Of links that
is L; of cells a0, and `natural.csv`: of rows of `cells.csv`, counted from 0, aa, bb and ab in place of |A0|²,
|B0|² and A0·B0, so that e1 = (|A|² − aa)/(2 aa), e2 = (|B|² − bb)/(2 bb), g = (A·B − ab)/a0, and in P and Q
aa and bb in place of |A0|² and |B0|². Stiffness and damping are of these sides. The masses of `nodes.csv` are
on the flat sheet, where these springs pull.
"""
CONTACT = """
## Obstacles

- `obstacles.csv`: rigid bodies where they are at last, in `a` a plane's unit normal, towards the sheet, or a
  cylinder's axis.
- `contacts.csv`: points X = Σ weight × mass in cells of the mid-surface, each with an obstacle that it may
  touch, of radius 0 a plane, of axis 0 a sphere. With y = X − position, on a cylinder less its part along the
  axis, and ρ = offset + radius, the depth d = offset − y·n on a plane, n its normal, else d = (ρ² − |y|²)/2ρ
  and n = y/ρ. Where d > 0, E = ½ k d² area, k the stiffness [N/m³], and the gradient by X is −k d area n,
  weight times that on each mass. The offset is half the thickness and 1e-9 of it. The energy of `states.csv`
  is that of springs and contact. sheetbench itself has integrals over the patch that touches a ball or a
  cylinder, or a sheet that curls by itself; points are no closer than half a radius.
"""
PAGE = """\
# {title}

{about}

SI units throughout. Masses are numbered from 0. `check.csv` and `states.csv` hold {states} to test a
program by: with these displacements it should find these forces and energies, to rounding. A corner `4+5`
is the mean of masses 4 and 5.

## Springs

Energy E of all springs, force −∂E/∂x on every mass; `check.csv` has the gradient +∂E/∂x, which is what
supports and loads balance at rest.

- `links.csv`: masses a and b, rest length L, stiffness k. With r the vector from a to b, E = ½ k (|r| −
  L)². Shares of links on the sheet's boundary are in k already.
- `cells.csv`, kind `area`: corners 1 to 4 in turn, each a mass or the mean of several; d1 from corner 1 to
  3, d2 from 2 to 4, c = d1 × d2, n = c/|c|, area a = ½ |c|, a0 at rest. E = ½ k1 (a/a0 − 1)² a0. With τ =
  k1 (a/a0 − 1) the gradient is ½ τ d2 × n on corner 3, ½ τ n × d1 on corner 4, and the opposite on corners
  1 and 2.
- kind `strain`: sides A = (d1 − d2)/2 and B = (d1 + d2)/2, at rest A0 and B0, a0 = |A0| |B0|, and the Green
  strains e1 = (|A|² − |A0|²)/(2 |A0|²), e2 = (|B|² − |B0|²)/(2 |B0|²), g = A·B/a0. E = ½ (k1 e1² + k2 e2² +
  k3 g²) a0. With t = (k1 e1, k2 e2, k3 g) the gradient by A is P = a0 (t1 A/|A0|² + t3 B/a0), by B it is Q
  = a0 (t2 B/|B0|² + t3 A/a0); on corners 1 to 4 it is ½ (−P − Q), ½ (P − Q), ½ (P + Q), ½ (Q − P).
- kind `coupling`, of fibres and at oblique rims: strains as above, E = (k1 e1 e2 + k2 e1 g + k3 e2 g) a0 and
  t = (k1 e2 + k2 g, k1 e1 + k3 g, k2 e1 + k3 e2).
- kind `rubber`: a membrane of rubber. With A and B as above, q = corner 1 − 2 + 3 − 4, C11 = (|A|² +
  |q|²/12)/|A0|², C22 = (|B|² + |q|²/12)/|B0|², C12 = A·B/a0, T = C11 + C22, D = C11 C22 − C12², x = T + θ
  − 3 and c10, c01, c20, c30, v, limit = k1 … k6 it stores W a0, W = f + c01 (D + θ T − 3) − (c10 + 2 c01)
  ln(D θ) + v/8 ln²(D θ), f = c10 x + c20 x² + c30 x³ or, of a limit that is not 0, −c10 limit ln(1 −
  x/limit). θ, the square of the thickness' stretch, is where nothing pulls: with F = f′ the one root of θ
  (F + c01 T) − c10 − 2 c01 + v/4 ln(D θ). Less ½ k7 (la − |A0|)² + ½ k8 (lb − |B0|)², la² = |A|² + |q|²/4,
  lb² = |B|² + |q|²/4. With wT = F + c01 θ, wD = c01 − θ (F + c01 T)/D, s = a0 (wT + wD C22)/|A0|², t = a0
  (wT + wD C11)/|B0|², pa = k7 (1 − |A0|/la) and pb = k8 (1 − |B0|/lb) P = (2 s − pa) A − 2 wD C12 B, Q =
  (2 t − pb) B − 2 wD C12 A, and R = ((s + t)/6 − (pa + pb)/4) q on corners 1 and 3, −R on 2 and 4, beside
  what P and Q give.
- kind `face`: sides A along the sheet and B between layers, γ = A·B/(|A| |B0|), E = ½ k1 γ² a0. P = a0 k1
  γ (B/(|A| |B0|) − γ A/|A|²), Q = a0 k1 γ A/(|A| |B0|).
- What acts on a corner is shared equally by the masses it is the mean of. A stiffness may be negative: the
  energy of all springs together is positive all the same.
{natural}
## Motion

`nodes.csv` has the masses. Dampers resist the rates of what the springs resist: force c d|r|/dt along a
link, the gradients above with c1 (da/dt)/a0 and (c1 de1/dt, c2 de2/dt, c3 dg/dt) in place of τ and t, and so
of the couplings; of rubber those of its small strains, rows of kind `area` and `strain` without stiffness.
Drag on every mass: {rate:g} 1/s × mass × velocity, against its motion.

Largest steps with these masses, springs and dampers, in `motion.json` too: {steps[symplectic_euler]:.4g} s
of symplectic Euler (v ← v + h a(x, v), x ← x + h v), {steps[velocity_verlet]:.4g} s of velocity Verlet
(w = v + h/2 a(x, v), x ← x + h w, v ← w + h/2 a(x, w)), a the force over the mass, dampers included:
{share:g} of the limit at the highest frequency, {highest:.4g} Hz{bound}. To come to rest soonest: the lowest
mode, {lowest:.4g} Hz flat, is critically damped by a drag of {critical:.4g} 1/s × mass × velocity.

## Supports and loads

- `supports.csv`: the mean displacement of the masses along one component is held.
- `loads.csv`: dead forces on masses; where a mass is not named, none.
- `followers.csv`: `pressure` p on a cell: with c the cross product, at every corner, of the side to the next
  corner and the side to the one before, p/36 (4 c + 2 (c of the next + c of the one before) + c of the one
  across) on each corner, p/2 d1 × d2 in all. `moment` M of an edge, its four
  columns a top mass, a bottom mass, and the columns before and after them: with D from bottom to top and t
  the unit vector from the mean of the one before to that of the one after, F = M (t × D)/|D|² on the top
  and −F on the bottom mass.
{notes}
## The same as arrays

`lattice.npz` (NumPy) and `lattice.mat` (MATLAB, Octave: add 1 to numbers of masses), p = {layers}:

{arrays}

Programs that read this folder and solve it, of rubber and obstacles the one in NumPy: `sheetbench calibrate
SCENE --for numpy --out DIR`, likewise `cpp` and `matlab`.
"""


def page(lattice: Description, scene: Scene, calibration: Calibration, others: Iterable[str] = ()) -> str:
    """Return the README, in Markdown; others: names of files beside it for one code."""
    nx, ny, layers = calibration.grid
    sheet = scene.sheet
    properties = [f"{name}: {text}" for name, text in in_words(scene) if name.split()[0] in OWN]
    missing = MISSING if len(lattice.mass) < nx * ny * layers else ""
    summary = (
        f"{nx} × {ny} × {layers} masses of a sheet of {sheet.length_x:g} × {sheet.length_y:g} × "
        f"{sheet.thickness:g} m, springs by the calibration {calibration.method}; "
        f"{markdown('; '.join(properties))}. {missing}Written by sheetbench {version()}."
    )
    notes = "".join(f"- Not included: {markdown(note)}\n" for note in lattice.notes)
    notes += "".join(f"\nFor one code: `{name}`.\n" for name in others) + CONTACT * bool(scene.obstacles)
    return PAGE.format(
        title=f"The lattice of {markdown(scene.name)}",
        about=summary,
        states=" and ".join(f"`{state.name}` ({state.meaning})" for state in lattice.states),
        rate=lattice.damping_rate,
        steps=lattice.steps.advised,
        share=lattice.steps.share,
        bound="" if lattice.steps.exact else ", a bound: dampers or contact may allow more",
        highest=lattice.steps.highest,
        lowest=lattice.steps.lowest,
        critical=lattice.steps.critical_rate,
        layers=layers,
        natural=NATURAL if scene.natural_by else "",
        notes=notes,
        arrays="\n".join(f"- `{name}` {markdown(note)}" for name, note in NAMES.items()),
    )


SOFA = "sofa"  # has links alone
READERS = {"numpy": "read_lattice.py", "cpp": "read_lattice.cpp", "matlab": "read_lattice.m"}
IN_MOTION = ("c", "fmu")  # programs that step it
CODES = (SOFA, *READERS, *IN_MOTION)


def lattice_files(
    scene: Scene, calibration: Calibration, code: str | None = None, precision: str = "double"
) -> tuple[dict[str, Write], list[str]]:
    """Return the files of a scene's lattice with calibrated springs, and sentences about parts of the scene
    that are left out.

    code: of `CODES`, with a file of its own beside the lattice's, or with other files in their place;
    precision: of programs in motion. Raises BadInput for lattices that files cannot hold (`lumped.describe`),
    and for features that the code lacks."""
    import lumped

    require_no_obstacles(scene, "an exported lattice", Box)
    if code in IN_MOTION:
        motion = program(scene, calibration, precision)
        if code == "fmu":
            return fmu_files(scene.name, motion)
        return {name: partial(write_text, text=text) for name, text in motion.texts.items()}, []
    if code == SOFA:
        require_flat_at_rest(scene, "--for sofa")
    if code in (SOFA, "cpp", "matlab"):
        require_no_obstacles(scene, f"the reader of --for {code}")
    lattice = lumped.describe(scene, calibration)
    added = {name: script(name) for reader, name in READERS.items() if reader == code}
    if code == SOFA:
        added = {"sofa.scn": to_sofa(lattice, scene)}
    extra = {"motion.json": to_json(lattice.steps.as_dict())}
    extra |= {"natural.csv": natural(lattice)} if scene.natural_by else {}
    extra |= contacts(lattice, scene) if scene.obstacles else {}
    texts = {**tables(lattice), **extra, "README.md": page(lattice, scene, calibration, added), **added}
    values = arrays(lattice)
    files: dict[str, Write] = {name: partial(write_text, text=text) for name, text in texts.items()}
    files["lattice.npz"] = partial(write_npz, values=values)
    files["lattice.mat"] = partial(write_mat, values=values)
    return files, list(lattice.notes)


def export(
    folder: Path | str,
    scene: Scene,
    calibration: Calibration,
    command: Sequence[str] = (),
    overwrite: bool = False,
) -> str:
    """Write the lattice of a scene with calibrated springs; return a sentence with the folder and its files.

    command: for the manifest. Raises BadInput for a folder that cannot be had or holds another scene's files,
    unless `overwrite`, and for lattices that files cannot hold."""
    files, missing = lattice_files(scene, calibration)
    target = Folder(
        folder,
        "export",
        command,
        about={"scene": scene.document()},
        variant={"lattice": calibration.title},
        overwrite=overwrite,
        option="--export",
    )
    for name, write in files.items():
        target.write(name, write)
    target.note(calibration.document())
    notes = "".join(f"; {note}" for note in missing)
    return f"Springs, masses, supports and loads in {target.path}: start at its README.md{notes}"
