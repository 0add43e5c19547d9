"""Error and time of ten fixed cases, a file a release: `python benchmarks/versions.py VERSION`.

The rows go to `benchmarks/versions/VERSION.json`; `docs/version_page.py` shows all files together. An error
is the largest difference from the values of a finer mesh, over their largest. The first release stores these
values; later ones read them, so that a change of the reference itself shows too.
"""

import json
import platform
import sys
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from time import process_time

import numpy as np
from keeping import machine

import sheetbench as sb
from sheetbench.numerics.threads import one_blas_thread

FOLDER = Path(__file__).parent / "versions"
RUBBER = "examples/rubber/inflated-square.toml"
REPEATS = 5
FINE = "shell:elements=24"


def displaced(name: str, model: str) -> Callable[[], np.ndarray]:
    """Return a call that gives the displacements at a scene's probes (p, 3) [m]."""
    scene = sb.load(Path(__file__).parents[1] / name if name.endswith(".toml") else name)
    points = scene.probe_points()
    return lambda: sb.solve(scene, model).displacement(points)


def swung(grid: int, error: float | None = None) -> Callable[[], np.ndarray]:
    """Return a call that gives P4 of the settling sheet over 0.2 s (t, 3) [m], with steps of an error."""
    return lambda: sb.simulate("two-edges-settling", 0.2, every=0.01, grid=grid, error=error).probes["P4"]


def vibrating(grid: int) -> Callable[[], np.ndarray]:
    """Return a call that gives the first four frequencies of a lattice (4,) [Hz]."""
    return lambda: sb.modes("two-edges-clamped", grid=grid, count=4, reference=()).frequencies


CASES: dict[str, tuple[Callable[[], np.ndarray], Callable[[], np.ndarray]]] = {
    **{
        f"{Path(name).stem}, {model}": (displaced(name, model), displaced(name, truth))
        for name, model, truth in (
            ("two-edges-clamped", "lumped:grid=9", FINE),
            ("two-edges-clamped", "lumped:grid=17", FINE),
            ("two-edges-clamped", "shell:elements=8", FINE),
            ("one-edge-clamped", "lumped:grid=9", FINE),
            ("curved-edge", "lumped:grid=17,grading=auto", FINE),
            ("fabric-square", "lumped:grid=17", FINE),
            ("ray-fin", "lumped:grid=17", FINE),
            (RUBBER, "lumped:grid=17", "solid:elements=12"),
        )
    },
    "two-edges-clamped, modes, grid 9": (vibrating(9), vibrating(33)),
    "two-edges-settling, grid 9": (swung(9), swung(17, 1e-7)),
}


def row(call: Callable[[], np.ndarray], truth: np.ndarray) -> dict[str, float]:
    """Return error [-] and CPU time [s] of a call, the least of some, on one thread."""
    seconds = []
    for _ in range(REPEATS):
        begun = process_time()
        values = call()
        seconds.append(process_time() - begun)
    return {"error": float(np.abs(values - truth).max() / np.abs(truth).max()), "seconds": min(seconds)}


def main(version: str) -> None:
    """Measure the cases and write the version's file."""
    FOLDER.mkdir(exist_ok=True)
    stored = FOLDER / "values.json"
    values = json.loads(stored.read_text()) if stored.exists() else {}
    rows = {}
    with one_blas_thread():
        for name, (call, fine) in CASES.items():
            if name not in values:
                values[name] = np.asarray(fine()).tolist()
            rows[name] = row(call, np.array(values[name]))
            print(f"{name}: {100 * rows[name]['error']:.3f} %, {1e3 * rows[name]['seconds']:.1f} ms")
    date = f"{datetime.now(UTC):%Y-%m-%d}"
    about = {"date": date, "machine": machine(), "python": platform.python_version()}
    stored.write_text(json.dumps(values, indent=1) + "\n")
    (FOLDER / f"{version}.json").write_text(json.dumps({**about, "rows": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main(sys.argv[1])
