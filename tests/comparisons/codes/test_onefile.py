"""The lattice in motion as one C file: against `lumped`'s own steps, under compilers, on boards; inputs."""

import ctypes
import re
import shutil
import subprocess
import sys
import zipfile

import numpy as np
import pytest
from cases import CLAMP, GRAVITY, OBLONG, SILICONE, calibrated
from commands import python, run
from exported import BLOWN, MOMENT, PULL, SCENES

import lumped
from comparisons.codes.c_tables import identifiers
from comparisons.codes.fmu import description
from comparisons.codes.onefile import program
from sheetbench import scenes
from sheetbench.errors import BadInput
from sheetbench.scenes import Clamped, Held, Hinged, PointLoad, Pressure, Scene
from sheetbench.scenes.objects.springs import DamperSet

STRICT = ("-std=c99", "-pedantic", "-Wall", "-Wextra", "-Wconversion", "-Werror", "-O2")
needs_gcc = pytest.mark.skipif(shutil.which("gcc") is None, reason="no gcc on this machine")
SETTLING = scenes.load("two-edges-settling").replace(probes={"P4": (0.188, 0.188), "middle": (0.1, 0.09)})
STRIP = Scene("strip /* 1", OBLONG, SILICONE.replace(damping_rate=5.0), GRAVITY, (CLAMP,))
RISE = {"time": (0.0, 0.004, 0.02), "displacement": ((0, 0, 0), (0, 0, 0.001), (0.001, 0, 0.003))}
RAMP = {"time": (0.0, 0.01), "factor": (0.0, 1.0)}
LEVEL = scenes.Plane(position=(0.0, 0.0, -0.0026), friction=0.3, contact_damping=0.1)
MOVED = LEVEL.replace(
    friction=0.002, motion={"time": (0.0, 0.02), "displacement": ((0, 0, 0), (0.001, 0, -0.002))}
)
HINGES = (Hinged(edge="x0", motion=RISE), Held(edge="x1", components=("z",)))
TIED = DamperSet(axial=0.02, diagonal=0.01, vertical=0.1, cross=0.01)
TIP = {"rectangle": {"x": (0.1, 0.2), "y": (0, 0.1)}}
BODY = {"where": TIP, "mass": 0.01, "inertia": (1e-6, 1e-6, 1e-6)}
ROUND = scenes.Sphere(position=(0.15, 0.05, -0.0325), radius=0.03, friction=0.002, contact_damping=0.1)
BAR = scenes.Cylinder(position=(0.15, 0.05, -0.0225), axis=(0.1, 1.0, 0.0), radius=0.02, friction=0.3)
OWN = {
    "settling": (SETTLING, {}),
    "rate": (STRIP, {}),
    "falling": (STRIP.replace(supports=()), {}),
    "moved": (STRIP.replace(supports=(Clamped(edge="x0", motion=RISE),)), {}),
    "linear": (STRIP.replace(supports=(Clamped(edge="x0", motion=RISE | {"interpolation": "linear"}),)), {}),
    "hinges": (STRIP.replace(supports=HINGES), {}),
    "table of dampers": (STRIP.replace(dampers=TIED), {}),
    "lies down": (STRIP.replace(obstacles=(LEVEL,)), {}),
    "lifted": (STRIP.replace(obstacles=(MOVED,)), {}),
    "blown over time": (BLOWN.replace(loads=(Pressure(value=40.0, history=RAMP), MOMENT, PULL)), {}),
    "weight over time": (STRIP.replace(gravity=GRAVITY.replace(history=RAMP)), {}),
    "payload": (STRIP.replace(masses=[{"at": (0.2, 0.1), "mass": 0.003}]), {}),
    "three layers": (SETTLING, {"grid": (5, 5, 3)}),
    "air": (STRIP.replace(air={"density": 1.2, "drag": 1.0}), {}),
    "body": (STRIP.replace(masses=[BODY]), {}),
    "ball": (STRIP.replace(obstacles=(ROUND,)), {}),
    "bar": (STRIP.replace(obstacles=(BAR,)), {}),
}
LIKE = "graded half uniform cut woven skew sheared bimetal yeoh gent mooney-rivlin"
ALL = OWN | {name: SCENES[name] for name in LIKE.split()}
SIZE = '#include "sheet.h"\nextern const int SIZE; const int SIZE = sizeof(sheet);\n'


def compile_with(command, folder, texts, *words):
    """Write a program's files and compile them, warnings as errors."""
    folder.mkdir(exist_ok=True)
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    subprocess.run([*command, *STRICT, *words], cwd=folder, check=True)


class Sheet:
    """A compiled program: `call` of its functions, `row` of its outputs, `length` of its steps."""

    def __init__(self, folder, found):
        sources = ("sheet.c", "size.c", "-o", "sheet.so", "-lm")
        compile_with(["gcc"], folder, found.texts | {"size.c": SIZE}, "-shared", "-fPIC", *sources)
        self.library, self.found = ctypes.CDLL(str(folder / "sheet.so")), found
        single = "float sheet_real" in found.texts["sheet.h"]
        self.real = ctypes.c_float if single else ctypes.c_double
        self.library.sheet_get.restype = self.real
        self.room = ctypes.create_string_buffer(ctypes.c_int.in_dll(self.library, "SIZE").value)
        self.call("reset")

    def call(self, name, *given):
        three = [(self.real * 3)(*one) if np.ndim(one) else one for one in given]
        return getattr(self.library, f"sheet_{name}")(self.room, *three)

    def row(self):
        """Return probes, forces and energies, as a row of check.csv has them behind its time."""
        return np.array([self.call("get", n) for n in range(len(self.found.outputs))])

    def after(self, steps):
        """Take so many steps; return the row then."""
        self.call("step", steps)
        return self.row()

    def length(self):
        """Return a view of the step's length [s] in the struct."""
        return self.real.from_buffer(self.room, ctypes.sizeof(ctypes.c_double))


def off(sheet, steps=2000):
    """Return the largest differences from check.csv of displacements, forces and energies, and the peaks."""
    known = np.array([line.split(",") for line in sheet.found.texts["check.csv"].splitlines()[1:]], float)
    found = [sheet.row(), *(sheet.after(steps // (len(known) - 1)) for _ in known[1:])]
    units = list(sheet.found.outputs.values())
    ends = np.cumsum([units.count("m"), units.count("N")])
    gap, own = (np.split(np.abs(one), ends, axis=1) for one in (found - known[:, 1:], known[:, 1:]))
    return [one.max(initial=0.0) for one in gap], [one.max(initial=0.0) for one in own]


def springs_of(name):
    """Return a scene and its springs."""
    scene, settings = ALL[name]
    return scene, calibrated(scene, **({"grid": (5, 3)} | settings))


@needs_gcc
@pytest.mark.sweep(6)
@pytest.mark.parametrize(
    ("precision", "near", "real"), [("double", 1e-12, float), ("single", 1e-5, np.float32)]
)
@pytest.mark.parametrize("name", ALL)
def test_the_program_takes_the_steps_that_lumped_takes(name, precision, near, real, tmp_path):
    scene, springs = springs_of(name)
    stiffness = lumped.build_problem(scene, springs).assembly.all_families.link_stiffness_norm
    sheet = Sheet(tmp_path, program(scene, springs, precision))
    (moved, pulled, stored), (peak, force, energy) = off(sheet)
    assert moved < near * peak and stored < near * energy
    # Each step rounds u. Half an ulp of its peak, once, moves the reactions of "uniform" by 8.7e-13 of theirs
    # within 1000 steps in long double; from 2000 such steps the program is 2.1e-12 off and `lumped` 3.7e-12,
    # whatever the order of sums. The bound is the stiffness times an ulp of the peak: 2.0e-11 there.
    assert pulled < near * force + np.finfo(real).eps * stiffness * peak


NIGHTLY = [
    pytest.param(name, marks=pytest.mark.nightly)
    for name in ("lifted", "blown over time", "table of dampers", "air")
]


@pytest.mark.parametrize("compiler", ["gcc", "clang", "zig"])
@pytest.mark.parametrize("name", ["bimetal", *NIGHTLY])
@pytest.mark.parametrize("precision", ["double", "single"])
def test_compilers_and_sanitizers_find_no_fault(compiler, name, precision, tmp_path):
    command = zig() if compiler == "zig" else [shutil.which(compiler)]
    if command[0] is None:
        pytest.skip(f"no {compiler} on this machine")
    found = program(*springs_of(name), precision, 400)
    checks = [] if compiler == "zig" else ["-fsanitize=address,undefined", "-fno-sanitize-recover=all"]
    compile_with(command, tmp_path, found.texts, *checks, "main.c", "sheet.c", "-lm", "-o", "main")
    run = subprocess.run([tmp_path / "main"], cwd=tmp_path, capture_output=True, text=True)
    assert run.returncode == 0 and "as check.csv has it" in run.stdout, run.stdout + run.stderr
    text = (tmp_path / "check.csv").read_text().splitlines()
    row = text[5].split(",")
    text[5] = ",".join([*row[:3], repr(float(row[3]) + 1e-3), *row[4:]])
    (tmp_path / "check.csv").write_text("\n".join(text) + "\n")
    assert subprocess.run([tmp_path / "main"], cwd=tmp_path, capture_output=True).returncode == 1


def zig():
    """Return the command of zig's compiler, of the package ziglang."""
    there = subprocess.run([sys.executable, "-c", "import ziglang"], capture_output=True).returncode == 0
    return [sys.executable, "-m", "ziglang", "cc"] if there else [None]


TARGETS = {
    "x86_64-linux-gnu": (),
    "aarch64-linux-gnu": (),
    "thumb-freestanding-eabihf": ("-mcpu=cortex_m7", "-fno-math-errno"),
}


@pytest.mark.parametrize("target", TARGETS)
def test_boards_and_other_machines_have_room_for_it(target, tmp_path):
    if zig()[0] is None:
        pytest.skip("no ziglang in this environment")
    for grid in (5, 9):
        found = program(SETTLING, calibrated(SETTLING, grid, method="consistent"), "single", 20)
        board = ("-Os", "-target", target, *TARGETS[target])
        compile_with(zig(), tmp_path, found.texts, *board, "-c", "sheet.c", "-o", "sheet.o")
        assert (tmp_path / "sheet.o").stat().st_size < {5: 30_000, 9: 60_000}[grid]


@needs_gcc
@pytest.mark.parametrize("name", ["settling", "rate", "table of dampers", "hinges"])
def test_the_step_is_stable_and_a_fifth_more_is_not(name, tmp_path):
    sheet, largest = Sheet(tmp_path, program(*springs_of(name))), []
    for times in (1.0, 1.2):
        sheet.call("reset")
        sheet.length().value = times * sheet.found.step
        largest.append(np.abs(sheet.after(3000)[:6]).max())
    assert largest[0] < 0.3 and not largest[1] < 1.0


@needs_gcc
@pytest.mark.parametrize("what", ["force", "support", "natural"])
def test_inputs_are_what_a_scene_would_say(what, tmp_path):
    """What a call sets from the first step on, against a scene in which it comes up within that step; two
    sheets in one program."""
    h, rate = 5e-5, (0.0, 0.0, 0.2)
    strip = STRIP.replace(probes={"tip": (0.2, 0.05)})
    natural = {"strain": (0.01, 0.0, 0.002), "curvature": (2.0, -1.0, 0.5)}
    rise = {"time": (0.0, 0.5 * h), "factor": (0.0, 1.0)}
    way = ((0, 0, 0), (0, 0, 0), rate)
    course = {"time": (0.0, 0.5 * h, 0.5 * h + 1.0), "displacement": way, "interpolation": "linear"}
    calls = {
        "force": ("set_force", 0, (0.0, 0.1, 0.2)),
        "support": ("move_support", 0, [0.5 * h * v for v in rate], rate),
        "natural": ("set_curvature", 0, ctypes.c_double(2.0)),
    }
    known = {
        "force": {"loads": (PointLoad(at=(0.2, 0.05), force=(0.0, 0.1, 0.2), history=rise),)},
        "support": {"supports": (Clamped(edge="x0", motion=course),)},
        "natural": {"natural": natural | {"history": rise | {"factor": (1.0, 2.0)}}},
    }
    later = {"time": (0.0, 1e6), "factor": (1.0, 2.0)}  # springs are those of the last strain
    plain = strip.replace(natural=natural | {"history": later}) if what == "natural" else strip
    found = []
    for number, scene in enumerate((strip.replace(**known[what]), plain)):
        sheet = Sheet(tmp_path / str(number), program(scene, calibrated(strip, (5, 3)), "double", 20))
        first = sheet.room
        for room in (first, ctypes.create_string_buffer(len(first))):
            sheet.room = room
            sheet.call("reset")
            sheet.length().value = h
        sheet.room = first
        if scene is plain:
            sheet.call(*calls[what])
        found.append(np.array([sheet.after(1)[:-1] for _ in range(300)]))
    gap, peak = np.abs(found[1] - found[0]), np.abs(found[0])
    assert gap.max() < 1e-9 * peak.max() and gap[:, :3].max() < 1e-12 * peak[:, :3].max()
    left = sheet.row()
    sheet.room = room
    assert np.abs(left[:3]).max() > 0.0 and not sheet.row()[:3].any()  # the other has not moved


CRUSHED = PointLoad(at=(0.2, 0.05), force=(-100.0, 0.0, 20.0))
SLOW = [{"time": 0.1, "share": 0.2}]
REFUSED = {
    "actuators: x1": (scenes.load("actuated-edge"), {"grid": 3}),
    "turned inside out": (STRIP.replace(loads=(CRUSHED,)), {"grid": (5, 3)}),
    "branches": (STRIP.replace(material=SILICONE.replace(relaxation=SLOW)), {"grid": (5, 3)}),
}


@pytest.mark.parametrize("words", REFUSED)
def test_what_the_program_has_not_is_refused_by_name(words):
    scene, settings = REFUSED[words]
    with pytest.raises(BadInput, match=words):
        program(scene, calibrated(scene, **settings))


def test_names_that_are_alike_in_c_are_numbered():
    names = ["a b", "tip", "a_b", "a_b_2"]
    probes = {name: (0.1, 0.02 * k) for k, name in enumerate(names)}
    assert identifiers(names) == ["a_b", "tip", "a_b_2", "a_b_2_3"]
    found = program(STRIP.replace(probes=probes), calibrated(STRIP, (5, 3)), "double", 20)
    assert list(found.outputs)[6] == "a_b_2.ux" and "SHEET_POINT_a_b_2 = 2" in found.texts["sheet.h"]


def test_the_verb_writes_it(tmp_path, capsys):
    wanted = ["calibrate", "two-edges-settling", "--grid", "3", "--for", "c", "--precision", "single"]
    assert run(*wanted, "--out", str(tmp_path)) == 0
    files = {"sheet.h", "sheet.c", "main.c", "check.csv"}
    assert files <= {path.name for path in tmp_path.iterdir()}
    assert "typedef float sheet_real" in (tmp_path / "sheet.h").read_text()
    assert run("calibrate", "two-edges-settling", "--precision", "single") == 2
    assert "--precision" in capsys.readouterr().err


def test_an_fmi_unit_is_without_fault_and_held_by_a_controller(tmp_path):
    """FMPy's validator, its run against the program's own steps, and the controller of the manual."""
    fmpy = pytest.importorskip("fmpy", reason="no FMPy in this environment")
    from fmpy.validation import validate_fmu

    assert run("calibrate", "docs/tip.toml", "--grid", "5", "--for", "fmu", "--out", str(tmp_path)) == 0
    path = str(tmp_path / "sheet.fmu")
    assert validate_fmu(path) == []
    if not any(name.startswith("binaries/") for name in zipfile.ZipFile(path).namelist()):
        pytest.skip("no compiler on this machine")
    found = fmpy.simulate_fmu(path, stop_time=0.05, step_size=1e-3, output_interval=1e-3)
    scene = scenes.load("docs/tip.toml")
    springs = calibrated(scene, 5, method="consistent")
    step = 1e-3 / np.ceil(1e-3 / program(scene, springs, "double", 20).step - 1e-9)
    known = lumped.simulate(scene, springs, 0.05, step=step, every=1e-3, integrator="verlet")
    tip, energy = known.probes["tip"], known.energies["elastic"]
    assert np.abs(found["tip.uz"] - tip[:, 2]).max() < 1e-12 * np.abs(tip).max()
    assert np.abs(found["energy.elastic"] - energy).max() < 1e-12 * energy.max()
    held = python("docs/hold_tip.py", path)
    tip = float(re.search(r"tip at (\S+) mm", held.stdout)[1])
    assert abs(tip + 10.0) < 0.1, held.stdout + held.stderr


def test_a_unit_has_no_input_that_a_history_sets():
    """A tool that writes all inputs at every step would stop the history."""
    natural = {"curvature": (2.0, 0.0, 0.0), "history": RAMP}
    found = program(STRIP.replace(natural=natural), calibrated(STRIP, (5, 3)))
    text, first = description("strip", found), next(iter(found.outputs))
    assert "natural.factor" in found.inputs and "natural.factor" not in text
    assert f'"{1 + len(found.inputs)}" name="{first}"' in text


def test_without_a_compiler_a_unit_has_its_sources_alone(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(shutil, "which", lambda name: None)
    assert run("calibrate", "two-edges-clamped", "--grid", "3", "--for", "fmu", "--out", str(tmp_path)) == 0
    names = zipfile.ZipFile(tmp_path / "sheet.fmu").namelist()
    assert "sources/sheet.c" in names and not any("binaries" in name for name in names)
    assert "sources only" in " ".join(capsys.readouterr().out.split())
