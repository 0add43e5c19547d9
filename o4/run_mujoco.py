"""Bring the sheet of mujoco.xml to rest in MuJoCo and print the probes as JSON.

    pip install mujoco==4.0.0
    python run_mujoco.py [SECONDS]

Steps are implicit; velocities are set to zero whenever the kinetic energy has passed a peak.
"""

import json
import sys
import time
from pathlib import Path

import mujoco
import numpy as np

STEP, AT_REST = 2e-3, 1e-7  # s; of the longer side, that one more step would move


def main(seconds=60.0):
    folder = Path(__file__).parent
    sheet = json.loads((folder / "sheet.json").read_text())
    model = mujoco.MjModel.from_xml_path(str(folder / "mujoco.xml"))
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    rest = np.array(sheet["vertices"])
    size, before = np.ptp(rest, axis=0).max(), 0.0
    began = time.process_time()
    status, count = "step-limit", 0
    while time.process_time() - began < seconds:
        mujoco.mj_step(model, data)
        count += 1
        energy = float(data.qvel @ data.qvel)
        if not np.isfinite(energy):
            status = "non-finite"
            break
        if energy < before:
            data.qvel[:] = 0.0
            energy = 0.0
        before = energy
        move = STEP**2 * np.abs(data.qacc).max() + STEP * np.abs(data.qvel).max()
        if count > 10 and move < AT_REST * size:
            status = "converged"
            break
    moved = data.flexvert_xpos - rest
    probes = {n: (np.array(p["shares"]) @ moved[p["vertices"]]).tolist() for n, p in sheet["probes"].items()}
    spent = time.process_time() - began
    print(json.dumps({"status": status, "probes": probes, "solve_seconds": spent, "iterations": count}))


if __name__ == "__main__":
    main(*map(float, sys.argv[1:]))
