"""Load an exported lattice in MuJoCo, set and read its displacements."""

from __future__ import annotations

from typing import Any

import numpy as np


def loaded(mujoco: Any, text: str) -> tuple[Any, Any]:
    """Model and data of an MJCF text, under its loads."""
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    return model, data


def put(model: Any, data: Any, displacement: np.ndarray, rest: np.ndarray) -> None:
    """Masses where displacements (n, 3) [m] from their rest (n, 3) [m] say; held ones stand there already."""
    for joint in range(model.njnt):
        mass, axis = int(model.jnt_bodyid[joint]) - 1, int(np.argmax(model.jnt_axis[joint]))
        data.qpos[joint] = rest[mass, axis] + displacement[mass, axis] - model.body_pos[mass + 1][axis]


def displacement(data: Any, rest: np.ndarray) -> np.ndarray:
    """Displacements (n, 3) [m] of the masses."""
    moved: np.ndarray = data.site_xpos - rest
    return moved
