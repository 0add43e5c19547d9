"""Scenes as files: one that is good, those with a fault and what is said of it, those that float."""

from pathlib import Path

import pytest

from sheetbench import scenes

GOOD = scenes.catalogue()["one-edge-clamped"].read_text(encoding="utf-8")

SPRINGS = """[springs]
axial = 1.0
diagonal = 1.0
vertical = 1.0
cross = 1.0
cross_diagonal = 1.0
layer_distance = 0.001"""
BAD = {
    "unknown table": (GOOD + "[moon]\nspeed = 3.0\n", ["moon", "unknown key"]),
    "millimetres": (GOOD.replace("0.003", "3.0"), ["thickness", "metres"]),
    "incompressible": (
        GOOD.replace("0.48", "0.5"),
        ["material.poisson", "0.5", "less than 0.5; write 0.4999"],
    ),
    "text for a number": (GOOD.replace("0.003", '"three mm"'), ["sheet.thickness", "three mm", "number"]),
    "infinite": (GOOD.replace("54.5e6", "inf"), ["material.young", "inf", "finite"]),
    "probe off the sheet": (GOOD.replace("P4 = [0.188, 0.188]", "P4 = [0.188, 0.2]"), ["probes.P4", "0.2"]),
    "load off the sheet": (
        GOOD.replace(
            "[probes]", '[[load]]\nkind = "point"\nat = [0.3, 0.0]\nforce = [0.0, 0.0, 1.0]\n[probes]'
        ),
        ["load 1.at", "0.3"],
    ),
    "two supports on an edge": (
        GOOD.replace("[probes]", '[[support]]\nedge = "x0"\nkind = "hinged"\n[probes]'),
        ["x0", "two supports"],
    ),
    "degrees": (GOOD.replace('"clamped"', '"clamped"\ntilt = 5.0'), ["tilt: 5 rad is more than π/2"]),
    "not TOML": ("thickness: 3", ["not a TOML file"]),
}


def written(folder: Path, text: str) -> Path:
    path = folder / "scene.toml"
    path.write_text(text, encoding="utf-8")
    return path


def refusal(folder: Path, text: str) -> str:
    """Return the line that refuses the text, without the file's name."""
    path = written(folder, text)
    with pytest.raises(scenes.SceneError) as caught:
        scenes.load(path)
    said = str(caught.value)
    assert "\n" not in said and said.startswith(f"{path}: ")
    return said.removeprefix(f"{path}: ")
