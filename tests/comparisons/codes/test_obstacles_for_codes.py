"""Obstacles in the files for other codes: written for MuJoCo and Newton, refused by name for the others."""

import json

import pytest
from contact_cases import bent_over, laid_strip

from comparisons.codes.files import _geom
from comparisons.codes.setup import setup
from sheetbench.scenes import Plane, Sphere


@pytest.mark.usefixtures("coarse_limits")
@pytest.mark.parametrize("code", ["mujoco", "newton"])
def test_obstacles_are_written(code, tmp_path):
    scene = laid_strip(
        0.1,
        obstacles=(Plane(position=(0, 0, -0.2), normal=(1, 0, 3)), Sphere(position=(1, 0, -0.3), radius=0.1)),
    )
    for name, write in setup(scene, code, 2, best=False).files().items():
        write(tmp_path / name)
    sheet = json.loads((tmp_path / "sheet.json").read_text())
    assert [one["kind"] for one in sheet["obstacles"]] == ["plane", "sphere"]
    assert sheet["offset"] == 0.0025
    if code == "mujoco":
        mujoco = pytest.importorskip("mujoco")
        model = mujoco.MjModel.from_xml_path(str(tmp_path / "mujoco.xml"))
        assert model.ngeom == 2
        assert not model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_CONTACT


@pytest.mark.usefixtures("coarse_limits")
def test_others_refuse_them():
    note = " ".join(setup(bent_over(), "genesis", 2, best=False).notes())
    assert "No files: obstacle: Genesis" in note


def test_mujocos_cylinder_is_long_and_friction_has_tangents():
    """Its size is radius and half length; condim 3 is a normal and two tangents, 1 a normal alone."""
    rod = {
        "kind": "cylinder",
        "position": [0.0] * 3,
        "axis": [0.0, 1.0, 0.0],
        "radius": 0.01,
        "friction": 0.3,
    }
    assert 'size="0.01 0.5"' in _geom(rod) and 'condim="3"' in _geom(rod)
    assert 'condim="1"' in _geom({**rod, "friction": 0.0})
