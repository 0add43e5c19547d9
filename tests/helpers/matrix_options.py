"""Options that verbs share, by dimension, and scenes that the catalogue lacks."""

from pathlib import Path

from cases import sheet

from sheetbench.choices import CALIBRATIONS
from sheetbench.scenes import Clamped, Hinged
from sheetbench.scenes.language.toml import to_toml

SCENES = (
    *(("two-edges-clamped",), ("one-edge-clamped",), ("curved-edge",), ("actuated-edge",)),
    *(("two-edges-settling",), ("{springs}",), ("{pressed}",), ("{weightless}",)),
)
GRIDS = (("--grid", "3"), ("--lumped", "3x4"), ("--grid", "3x3x3"), ("--grid", "5"))
SPRINGS = (  # without fits, each of which solves its scenes first: `calibrate` has them
    (),
    *(("--calibration", name) for name in (*CALIBRATIONS, "auto") if "fit" not in name),
    ("--k", "550"),
    ("--k", "550", "--layer-distance", "0.004"),
    ("--layer-distance", "0.002"),
    *(("--grading", value) for value in ("0.4", "auto")),
    ("--calibration", "consistent-membrane", "--grading", "0.4:x0,y0"),
)
OUTPUTS = (
    (),
    ("--json",),
    ("--out", "{folder}"),
    ("--out", "{folder}", "--figure", "svg:single"),
)

FILES = {
    "springs": "[springs]\naxial = 5000.0\ndiagonal = 5000.0\ncross = 5000.0\ncross_diagonal = 5000.0\n"
    "vertical = 5000.0\nlayer_distance = 0.003\n",
    "pressed": '[[load]]\nkind = "pressure"\nvalue = 20.0\n[[load]]\nkind = "edge"\nedge = "x1"\n'
    "force_per_length = [0.1, 0.0, 0.05]\n",
    "natural": "[natural]\nstrain = [0.002, 0.0, 0.0]\ncurvature = [3.0, 0.0, 1.0]\n"
    "history = { time = [0.0, 0.002], factor = [0.0, 1.0] }\n[[patch]]\n"
    "shape = { rectangle = { x = [0.03, 0.07], y = [0.0, 0.1] } }\n"
    "natural = { curvature = [9.0, 0.0, 0.0] }\n",
    "touching": '[[obstacle]]\nkind = "plane"\nposition = [0.0, 0.0, -0.003]\n',
    "weightless": "",
}
TABLES = {  # what was measured: rows of numbers below the header, and headers alone
    "heights": "x,y,uz\n0.05,0.05,-0.001\n0.1,0.05,-0.003\n0.11,0.1,-0.004\n0.08,0.03,-0.002\n",
    "displacements": "x,y,ux,uy,uz\n0.05,0.05,0,0,-0.001\n0.1,0.05,-1e-4,,-0.003\n0.11,0.1,-2e-4,0,-0.004\n",
    "motion": "time,x,y,uz\n0.002,0.1,0.05,-1e-5\n0.004,0.1,0.05,-5e-5\n0.006,0.1,0.05,-1.2e-4\n"
    "0.008,0.1,0.05,-2e-4\n",
    "empty": "x,y,uz\n",
}


def scene_files(folder: Path) -> dict[str, str]:
    """Write scenes that the catalogue lacks, and measurements, into a folder; their paths by name."""
    found = {}
    for name, more in FILES.items():
        held = (Hinged if more else Clamped)(edge="x0"), Clamped(edge="x1")
        weight = 0.0 if name == "weightless" else 9.81
        scene = sheet(0.12, 0.1, 0.003, 1e6, 0.4, name=name, supports=held, weight=weight, probes={})
        (folder / f"{name}.toml").write_text(to_toml(scene) + more, encoding="utf-8")
        found[name] = str(folder / f"{name}.toml")
    for name, text in TABLES.items():
        (folder / f"{name}.csv").write_text(text, encoding="utf-8")
        found[name] = str(folder / f"{name}.csv")
    return found
