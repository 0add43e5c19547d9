"""The program that reads a C3D file for `c3d`: `python c3d_reader.py FILE`.

ezc3d ends by a signal, or does not end, on files that are damaged. Standard output: an archive of NumPy with
labels (n,), position (3, n, frames) in the file's unit, unit and rate [1/s].
"""

import os
import sys
from io import BytesIO
from typing import Any

import numpy as np

REFUSED = 2  # exit status; what is wrong is the last line of standard error


def read(path: str) -> dict[str, Any]:
    """Return labels, positions, unit and rate of the markers of a C3D file."""
    import ezc3d

    content = ezc3d.c3d(path)
    point = content["parameters"]["POINT"]
    return {
        "unit": str(point["UNITS"]["value"][0] or "m"),
        "rate": float(point["RATE"]["value"][0]),
        "labels": np.array([str(label) for label in point["LABELS"]["value"]], dtype=np.str_),
        "position": np.asarray(content["data"]["points"][:3], dtype=float),
    }


if __name__ == "__main__":
    output = os.dup(1)
    os.dup2(2, 1)  # what ezc3d prints is no part of the archive
    try:
        markers = read(sys.argv[1])
    except Exception as error:  # ezc3d has no error of its own
        print(f"{error}", file=sys.stderr)
        sys.exit(REFUSED)
    archive = BytesIO()
    np.savez(archive, **markers)
    with os.fdopen(output, "wb") as file:
        file.write(archive.getvalue())
