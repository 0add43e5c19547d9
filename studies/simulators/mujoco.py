"""An exported lattice in MuJoCo: loaded, put somewhere, brought to rest."""

from __future__ import annotations

from typing import Any

import numpy as np

AT_REST = 1e-9  # displacement, in sides of the sheet, that one more step would add
STEPS = 30_000


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
    found: np.ndarray = data.site_xpos - rest
    return found


def at_rest(mujoco: Any, model: Any, data: Any, size: float) -> int:
    """Steps, velocities put to nothing whenever the motion has passed a peak, until one more would move
    nothing; how many, 0 where STEPS did not do."""
    before, step = 0.0, model.opt.timestep
    for count in range(1, STEPS + 1):
        mujoco.mj_step(model, data)
        energy = float(data.qvel @ data.qvel)
        if not np.isfinite(energy):
            return 0
        if energy < before:
            data.qvel[:] = 0.0
            energy = 0.0
        before = energy
        moved = step**2 * np.abs(data.qacc).max() + step * np.abs(data.qvel).max()
        if count > 10 and moved < AT_REST * size:
            return count
    return 0
