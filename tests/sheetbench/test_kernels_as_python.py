"""Kernels with NUMBA_DISABLE_JIT=1, where they run as Python: for debuggers, mutants and machines without a
compiler. They give what compiled ones do."""

import json
import os
import subprocess
import sys
from typing import Any

import pytest

ASK = """
import json

import fem_reference, lumped
import sheetbench as sb


def numbers():
    clamped = sb.load("two-edges-clamped")
    settling = sb.load("two-edges-settling")
    rubber = clamped.replace(material=clamped.material.replace(law="neo-hookean"))
    at = [[0.1, 0.15]]
    springs, elastic = (lumped.calibrate(clamped.sheet, one.material, 3) for one in (clamped, rubber))
    return {
        "lattice": lumped.solve(clamped, springs).displacement(at).tolist(),
        "rubber lattice": lumped.solve(rubber, elastic).displacement(at).tolist(),
        "shell": fem_reference.solve(clamped, elements=1).displacement(at).tolist(),
        "lattice's modes": [lumped.modes(clamped, springs, 2).frequencies.tolist()],
        "shell's modes": [fem_reference.modes(clamped, elements=1, count=2).frequencies.tolist()],
        "esdirk": lumped.simulate(settling, springs, 4e-3).probes["P4"].tolist(),
        "verlet": lumped.simulate(settling, springs, 5e-4, integrator="verlet").probes["P4"].tolist(),
    }
"""


@pytest.mark.nightly  # half a minute of Python
def test_they_give_what_compiled_ones_do():
    ran = subprocess.run(
        [sys.executable, "-c", f"{ASK}\nprint(json.dumps(numbers()))"],
        env={**os.environ, "NUMBA_DISABLE_JIT": "1"}, capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert ran.returncode == 0, ran.stderr[-2000:]
    here: dict[str, Any] = {}
    exec(ASK, here)
    for name, found in here["numbers"]().items():
        flat, same = ([x for row in rows for x in row] for rows in (found, json.loads(ran.stdout)[name]))
        assert same == pytest.approx(flat, rel=1e-6, abs=1e-9 * max(map(abs, flat))), name
