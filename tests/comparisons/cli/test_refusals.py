"""Command lines that no verb can answer: exit status 2 and one line with the option and what is allowed."""

import shlex
from pathlib import Path

import pytest
from commands import one_line, run

from sheetbench.scenes import Clamped, load

ONE, TWO = "one-edge-clamped", "two-edges-clamped"
IDENTIFY = f"identify {TWO} --measured measured.csv"
SIMULATE = f"simulate {TWO} --lumped 3 --duration 0.01"
HUGE = "9" * 19
STRIP = "calibrate --young 1e6 --poisson 0.3 --thickness 0.002 --side 0.1"
ROWS = {
    f"tradeoff {ONE} --tolerance 2": "tolerance = 2: a fraction",
    f"tradeoff {ONE} --budget -1": "budget = -1",
    f"tradeoff {ONE} --tolerance 0.1 --calibration uniform,axial": "--calibration: with --tolerance|one",
    f"tradeoff {ONE} --tolerance 0.1 --shell 4": "--shell: no effect with --tolerance",
    f"tradeoff {ONE} --tolerance 0.1 --duration 1": "--duration: no effect with --tolerance",
    f"tradeoff {ONE} --budget 5ms --workers 2": "--workers: no effect with --budget",
    "calibrate": "--young|--poisson|--thickness|--side",
    f"calibrate {TWO} --poisson 0.5": "--poisson|0.5",
    f"calibrate {TWO} --side 18q": "--side|18q",
    f"calibrate {TWO} --side 0.001": "thickness|0.001",
    f"calibrate {TWO} --calibration guess": "guess|consistent",
    f"calibrate {TWO} --calibration consistent --k 550": "k|consistent|uniform",
    f"calibrate {TWO} --toml --json": "--toml|--json",
    f"calibrate {TWO} --toml --for newton": "--toml: no effect with --for",
    f"calibrate {TWO} --toml --for cpp --grid 3": "--toml: no effect with --for",
    f"calibrate {TWO} --calibration central --for newton": "--calibration: no effect with --for newton",
    f"calibrate {TWO} --grid 3 --for bullet": "bullet|newton, mujoco, pybullet, genesis, sofa",
    f"calibrate {TWO} --grid 3 --for sofa --calibration consistent": "--calibration central",
    f"calibrate {TWO} --grid 3 --for mujoco --calibration central": "--calibration: no effect with",
    f"calibrate {TWO} --export a --for sofa": "--export: no effect with --for",
    f"calibrate {TWO} --cell bricks --grid 3": "--grid: no effect with --cell",
    f"calibrate {TWO} --spacing 1mm": "--spacing: no effect without --cell",
    f"calibrate {TWO} --hinge angle": "--hinge: no effect without --cell",
    "calibrate --cell bricks": "--cell: needs a SCENE",
    f"calibrate {TWO} --cell bricks --coefficient k": "--coefficient k: NAME=VALUE",
    f"calibrate {TWO} --cell bricks --coefficient mu=nan": "--coefficient mu=nan: not finite",
    f"calibrate {TWO} --cell equilateral --coefficient hinge=-1": "hinge=-1|negative stiffness",
    f"calibrate {TWO} --cell equilateral --spacing 10": "--spacing = 10 m|to 0.188",
    f"calibrate {TWO} --cell equilateral --spacing 1e-9": "--spacing = 1e-09 m",
    f"check {ONE} --schema": "SCENE: no effect with --schema",
    f"{STRIP} --calibration auto": "calibration = auto",
    "calibrate --young '2 mm'": "a stress or modulus is needed",
    "calibrate --density '1.1 g'": "a density is needed",
    "calibrate --side '2 s' --young 1e6 --poisson 0.4 --thickness 1e-3": "--side = '2 s': '2 s' is",
    "calibrate --young '1 MPa x'": "'--young': 'x' is no known unit",
    "calibrate --young ''": "'--young': '' is no quantity",
    "calibrate --young": "'--young' requires an argument; see sheetbench --help",
    "calibrate --yung 1": "No such option: --yung",
    "compare": "Missing argument 'SCENE'; see sheetbench compare --help",
    "compare no-such-scene": f"no-such-scene|{TWO}",
    f"compare {ONE} --elements many": "--elements = 'many'",
    f"tradeoff {TWO} --duration 0.1 --repeats 2": "--repeats: no effect with --duration",
    f"tradeoff {TWO} --integrator esdirk": "--integrator: no effect without --duration",
    f"compare {TWO} --lumped {HUGE}": "grid",
    f"compare {TWO} --reference beam": "beam|shell",
    f"compare {TWO} --elements 0": "elements|0",
    f"compare {TWO} --elements {HUGE}": "elements",
    f"compare {TWO} --k -5": "k|-5",
    f"compare {TWO} --layer-distance 0": "layer-distance|0",
    f"compare {ONE} --lumped 3 --elements 2 --model absent.py:Strip": "absent.py",
    f"crosscheck {TWO} --lumped 9": "--lumped = '9'|rising",
    f"crosscheck {TWO} --solid 4x4,8x8": "--solid",
    f"crosscheck {TWO} --lumped '' --plate '' --shell '' --solid '' --judges ''": "no model left",
    f"crosscheck {TWO} --judges astrology": "--judges|astrology",
    f"{IDENTIFY} --unknown young,colour": "colour|young|poisson",
    f"{IDENTIFY} --unknown young,young": "each once",
    f"{IDENTIFY} --unknown curvature_x0": "x0|no support",
    f"{IDENTIFY} --unknown damping_time": "damping_time|does not depend on it",
    f"{IDENTIFY} --unknown tilt_x1": "tilt_x1|x1|no clamp",
    f"{IDENTIFY} --unknown tilt_x0": "tilt_x0|no tilt|corner|y0",
    f"{IDENTIFY} --model plate": "plate|shell",
    f"{IDENTIFY} --calibration fit-static": "fit-static",
    f"{IDENTIFY} --offset 0.001": "offset = 0.001 m|cloud",
    f"modes {ONE} --state-space 3 --about moving": "about = 'moving'",
    f"modes {ONE} --reduce balanced:4": "--reduce: no effect without --state-space",
    f"modes {ONE} --state-space 3 --elements 4": "--elements: no effect with --state-space",
    f"live {TWO} --port 70000": "--port",
    f"live {TWO} --grid 99": "grid = 99",
    f"live {TWO} --elements 8x4": "elements = 8×4: a number each",
    f"modes {ONE} --count 0": "--count",
    f"modes {ONE} --lumped 3 --count 500": "count = 500",
    "new a.toml --poisson 0.5": "--poisson = 0.5|less than 0.5; write 0.4999",
    "new a.toml --side '3 s'": "--side = '3 s'|length",
    "new a.toml --clamped x0,z1": "--clamped = 'z1'|y1",
    "new a.toml --thickness 2": "thickness = 2 m|metres",
    "new a.toml --side 120x80 --thickness 2": '120 mm is written 0.12 or "120 mm"',
    "new a.toml --young 0.25": '0.25 MPa is written 0.25e6 or "0.25 MPa"',
    "new a.toml --side 120mm,80mm": "120x80mm",
    "study reproduction --part dynamics": "errors, tables, settling, nearest",
    f"{SIMULATE} --integrator rk4": "choose from",
    f"{SIMULATE} --error 5": "error = 5: of a step|lies between 0 and 0.1",
    f"{SIMULATE} --duration -1": "duration = -1 s",
    f"{SIMULATE} --animate": "--animate: no effect without --out",
    f"{SIMULATE} --animate --no-pictures --out a": "--animate: no effect with --no-pictures",
    f"compare {ONE} --figure pdf": "--figure: no effect without --out",
    f"compare {ONE} --overwrite": "--overwrite: no effect without --out",
    f"compare {ONE} --every 1": "--every: no effect without --duration",
    f"simulate {TWO} --lumped 3 --duration 1 --step 1e-12": "steps to 1 s",
    f"{SIMULATE} --every 1e-11": "samples, 1e-11 s apart; 1e+07 at most",
    f"simulate {TWO} --lumped 3 --duration 1e9": "samples",
    f"stability {ONE} --vary load,weather": "vary = 'weather': unknown, choose one of load",
    "study nosuch": "study = 'nosuch': unknown, choose one of codes, ",
    "study promises --wrongly": "No such option: --wrongly; see sheetbench study promises --help",
    "study promises --model lumped": "model = 'lumped': unknown, choose one of plate, shell",
    "score --suite all": "statics, motion, modes",
    "score --case thin": "--case: no effect without ANSWERS",
    f"compare {ONE} --uncertainty --no-uncertainty": "--uncertainty and --no-uncertainty: give one",
    f"compare {ONE} --duration 0.1 --branch path": "--branch: no effect with --duration",
    f"tradeoff {ONE} --retry": "--retry: no effect without --out",
    f"crosscheck {ONE} --workers 2 --scheduler tcp://127.0.0.1:9": "no scheduler there with a worker",
    f"crosscheck {ONE} --judges '' --meshes 4,8": "--meshes: no effect without external codes",
    f"calibrate {ONE} --loss-factor 0.1": "--at HZ",
    f"calibrate {ONE} --loss-factor 0.1 --prony a.csv": "--prony and --loss-factor",
    f"calibrate {ONE} --at 5": "--at: needs --loss-factor",
    f"calibrate {ONE} --loss-factor=-1 --at 5": "--loss-factor = -1: must be greater than 0",
    f"calibrate {ONE} --for newton --loss-factor 0.1 --at 3": "--loss-factor: no effect|newton|stiffness",
    f"calibrate {ONE} --for mujoco --loss-factor 0.1 --band 1 9": "no effect with --for mujoco|Maxwell",
    f"identify {ONE} --tensile measured.csv": "SCENE: no effect with --tensile",
    "identify --tensile t.csv --unknown poisson": "--unknown: no effect with --tensile",
    "identify --tensile t.csv --law biot": "--law: no effect with --tensile",
    f"{IDENTIFY} --up-to 2": "--up-to: no effect without --tensile",
    f"{IDENTIFY} --area 18mm2": "--area: no effect without --tensile",
    f"{IDENTIFY} --model shell --lumped 5": "grid: no effect with the model shell",
    f"{IDENTIFY} --elements 16": "elements: no effect with the model lumped",
    "study transfer --methods magic": "magic|consistent",
    "study transfer --scenes moon": "moon|two-edges-clamped",
    "study transfer --part all": "all|static",
    "study transfer --grids 9,18": "9,18|4 n + 1",
    "study transfer --grids nine": "nine|4 n + 1",
    "study stability --part weather": "weather|published",
    f"stability {ONE} --reference cuboid": "cuboid|shell",
    f"stability {ONE} --figure pdf:single --out a": "both columns",
    f"modes {ONE} --figure jpg --out a": "--figure",
    f"modes {ONE} --figure svg --no-pictures --out a": "--no-pictures",
    f"calibrate {TWO} --cell bricks --hinge angle": "hinge: no effect on bricks, which have no hinges",
    f"report {300 * 'a'}": "too long",
    "check /dev/zero": "/dev/zero: larger than 64 MB, which no such file is",
    "score /dev/zero": "/dev/zero: larger than 256 MB, which no such file is",
    "report none": "there is no such folder",
    "report .": "no verb has written here",
    "weigh": "No such command 'weigh'; see sheetbench --help",
    "compare frame.toml --lumped 3x2": "3×2×2|every mass",
    "modes frame.toml --lumped 2x2": "2×2×2|every mass",
    "tradeoff two-edges-settling --duration 0.1 --scheduler tcp://127.0.0.1:9": "--scheduler = |no scheduler",
}


SHORT = {
    "compare": f"compare {ONE}",
    "modes": f"modes {ONE}",
    "calibrate": f"calibrate {ONE}",
    "simulate": f"simulate {ONE} --duration 0.01",
    "identify": f"identify {ONE} --measured measured.csv",
    "tradeoff": f"tradeoff {ONE}",
    "stability": f"stability {ONE}",
}
for verb, command in SHORT.items():
    ROWS |= {f"{command} --grading={wrong}": f"grading = {wrong}" for wrong in ("2", "-0.1", "fine", "nan")}
    ROWS[f"{command} --grid 9y"] = "9y|--grid"
    if verb not in ("calibrate", "simulate"):
        ROWS[f"{command} --elements 8y"] = "--elements = '8y'"


@pytest.mark.smoke
@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.replace(HUGE, "99…")[:80])
def test_a_bad_command_is_refused_in_a_line(row, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("measured.csv").write_text("x,y,ux,uy,uz\n0.094,0.094,,,-0.0024\n0.188,0.188,,,-0.0134\n")
    load(ONE).replace(supports=[Clamped(edge=edge) for edge in ("x0", "x1", "y0", "y1")]).save("frame.toml")
    assert run(*shlex.split(row)) == 2
    line = one_line(capsys)
    assert {path.name for path in tmp_path.iterdir()} == {"frame.toml", "measured.csv"}
    assert all(part in line for part in ROWS[row].split("|")), line
