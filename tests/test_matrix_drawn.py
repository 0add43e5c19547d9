"""Every verb on sheets as people build them: in every pair with a material, a plan, parts and loads."""

import pytest
from matrix_rows import named, pairwise

FIBRES = """
kind = "orthotropic"
young_1 = 1e8
young_2 = 2e7
poisson_12 = 0.3
shear_12 = 8e6
angle = 0.5
"""
LAYERS = "".join(f'[[layer]]\nthickness = 0.001\nangle = "{angle} deg"\n' for angle in (0, 90, 0))
PATCH = "[[patch]]\nshape = {{ rectangle = {{ x = [0.05, 0.07], y = [0.0, 0.08] }} }}\n{} = {}\n".format
WHERE = "where = { rectangle = { x = [%s], y = [0.0, 0.05] } }\n"
WEIGHT = "[gravity]\nacceleration = [0.0, 0.0, -9.81]\n"
PARTS = {  # of a scene's text: below [sheet], below [material], and tables
    "plain": ("", "young = 2e7\npoisson = 0.4\n", ""),
    "fibres": ("", FIBRES, ""),
    "laminate": ("", FIBRES, LAYERS),
    "outline": ("outline = [[0.0, 0.0], [0.12, 0.01], [0.12, 0.07], [0.0, 0.08]]\n", "", ""),
    "hole": ("", "", "[[cutout]]\nshape = { rectangle = { x = [0.08, 0.1], y = [0.03, 0.05] } }\n"),
    "notch": ("", "", "[[cutout]]\nshape = { rectangle = { x = [0.08, 0.1], y = [0.05, 0.08] } }\n"),
    "taper": ("taper_x = [0.003, 0.002]\n", "", ""),
    "stiff": ("", "", PATCH("density", 2e3)),
    "thick": ("", "", PATCH("thickness", 0.004)),
    "edge": ("", "", '[[support]]\nkind = "clamped"\nedge = "x0"\n'),
    "gripper": ("", "", '[[support]]\nkind = "clamped"\n' + WHERE % "0.0, 0.03"),
    "pressed": ("", "", '[[load]]\nkind = "pressure"\nvalue = 20.0\n' + WHERE % "0.05, 0.09"),
    "pulled": ("", "", '[[load]]\nkind = "edge"\nedge = "x1"\nforce_per_length = [1.0, 0.0, 0.2]\n'
               + WHERE % "0.1, 0.12"),
    "payload": ("", "", WEIGHT + '[[mass]]\nat = [0.11, 0.03]\nmass = "5 g"\n'),
    "spread": ("", "", WEIGHT + '[[mass]]\nmass = "5 g"\n' + WHERE % "0.03, 0.07"),
    "pins": ("", "", "".join(
        f'[[support]]\nkind = "point"\nat = [{at}]\n' for at in ("0.0, 0.02", "0.0, 0.06", "0.03, 0.04"))),
    "flat": ("", "", ""),
    "curled": ("", "", "[natural]\nstrain = [0.01, 0.0, 0.0]\ncurvature = [2.0, 0.0, 1.0]\n"
               "history = { time = [0.0, 0.001], factor = [0.0, 1.0] }\n"),
    "muscle": ("", "", PATCH("natural", "{ curvature = [9.0, 0.0, 0.0], strain = [0.0, 0.01, 0.0] }")),
    "warm": ("", "expansion = 1e-4\n", "[temperature]\nchange = 9.0\ngradient = 900.0\n"),
    "laid": ("", "", '[[load]]\nkind = "area"\nforce_per_area = [0.0, 0.0, 10.0]\n'),
}  # fmt: skip
KINDS = (
    ("plain", "fibres", "laminate"),
    ("outline", "hole", "notch"),
    ("taper", "stiff", "thick"),
    ("edge", "gripper", "pins"),
    ("flat", "curled", "muscle", "warm"),
    ("pressed", "pulled", "laid", "payload", "spread"),
)
SMALL, CAMPAIGN = "--lumped 5 --elements 2", "--workers 1 --quiet"
VERBS = (
    "check",
    f"compare {SMALL}",
    f"compare {SMALL} --reference solid",
    f"modes {SMALL} --count 2",
    "simulate --lumped 5 --duration 0.002",
    "calibrate --grid 5 --export {export}",
    f"tradeoff --lumped 5 --plate 2 --shell 2 --solid= --elements 3 --repeats 1 {CAMPAIGN}",
    f"stability {SMALL} --vary slenderness {CAMPAIGN}",
    "tradeoff --tolerance 0.9",
    "modes --lumped 5 --state-space 3",
)
ROWS = pairwise([tuple((verb,) for verb in VERBS), *(tuple((kind,) for kind in kinds) for kinds in KINDS)])


def text(kinds):
    """A scene of these kinds; a laminate is the same all over."""
    if "laminate" in kinds:
        kinds = [kind for kind in kinds if kind not in KINDS[2]]
    sheet, material, tables = ("".join(PARTS[kind][place] for kind in kinds) for place in range(3))
    return (
        f'name = "drawn"\n[sheet]\nlength_x = 0.12\nlength_y = 0.08\nthickness = 0.003\n{sheet}'
        f"[material]\ndensity = 1000.0\n{material}\n{tables}"
    )


def refused(verb, kinds):
    """A linear system has no followers; the solid has no steps in its thickness, nor followers on a taper."""
    if "--state-space" in verb:
        return "pressed" in kinds
    uneven = "thick" in kinds or ("taper" in kinds and {"pressed", "pulled"} & {*kinds})
    return "--reference solid" in verb and "laminate" not in kinds and bool(uneven)


@pytest.mark.usefixtures("few")
@pytest.mark.parametrize("row", ROWS, ids=named)
def test_drawn(row, ends, tmp_path):
    verb, *kinds = (part for one in row for part in one)
    (tmp_path / "drawn.toml").write_text(text(kinds), encoding="utf-8")
    name, *options = verb.split()
    if name in ("tradeoff", "stability"):
        options += ["--out", "{folder}"]
    status = ends(name, str(tmp_path / "drawn.toml"), *options)
    assert status == (2 if refused(verb, kinds) else 0)
