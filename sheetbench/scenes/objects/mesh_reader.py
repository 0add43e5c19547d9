"""Read the triangles and quadrilaterals of one mesh file: a program of its own, which `plan_mesh` runs.

    python mesh_reader.py FILE FORMAT

Standard output is an archive of NumPy's with `points` (n, 2 or 3) and, of what there is, `triangle` (k, 3)
and `quad` (m, 4), numbers of points from 0. Exit status 2 with a line on standard error says why there is
none. It imports nothing of ours, so that it starts within a fifth of a second.
"""

import sys
import warnings
from contextlib import redirect_stderr, redirect_stdout
from io import BytesIO, StringIO
from pathlib import Path

import numpy as np

CORNERS = {"triangle": 3, "quad": 4}
SHOWN = 6  # kinds of cells named
REFUSED = 2  # exit status


def read(path: Path, kind: str) -> dict[str, np.ndarray]:
    """Return the arrays of a file of one of meshio's formats. Raises ValueError with a clause."""
    import meshio

    if kind == "abaqus" and _includes(path):
        raise ValueError("*INCLUDE: other files are not read; write what they hold into this one")
    printed = StringIO()
    try:
        with redirect_stdout(printed), redirect_stderr(printed):  # it prints, and ends the process
            mesh = meshio.read(path, kind)
        found: dict[str, np.ndarray] = {"points": np.asarray(mesh.points, dtype=float)}
        for name, corners in CORNERS.items():
            blocks = [b.data for b in mesh.cells if b.type.rstrip("0123456789") == name and len(b.data)]
            if blocks:
                found[name] = np.concatenate([np.asarray(block)[:, :corners] for block in blocks])
    except MemoryError:
        raise ValueError("reading it takes more memory than a mesh may") from None
    except SystemExit:
        raise ValueError(f"meshio cannot read it: {_line(printed.getvalue())}") from None
    except KeyError as error:  # a number, mostly
        raise ValueError(f"it names {error.args[0]}, which the file does not have") from None
    except Exception as error:
        raise ValueError(f"meshio cannot read it: {type(error).__name__} {_line(str(error))}") from None
    if len(found) == 1:
        kinds = ", ".join(list(dict.fromkeys(block.type for block in mesh.cells))[:SHOWN]) or "none"
        raise ValueError(f"no triangles and no quadrilaterals; its cells: {kinds}")
    return found


def _includes(path: Path) -> bool:
    """Whether a line is what meshio takes for *INCLUDE."""
    with path.open(errors="replace") as file:
        return any(line.partition(",")[0].strip().replace("*", "").upper() == "INCLUDE" for line in file)


def _line(text: str) -> str:
    return " ".join(text.split())


if __name__ == "__main__":
    warnings.simplefilter("ignore")  # they would stand before the reason
    try:
        archive = BytesIO()
        np.savez(archive, **read(Path(sys.argv[1]), sys.argv[2]))  # type: ignore[arg-type]
        sys.stdout.buffer.write(archive.getvalue())
    except ValueError as error:
        sys.stderr.write(f"{error}\n")
        sys.exit(REFUSED)
