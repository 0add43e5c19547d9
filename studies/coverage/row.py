"""The row of `make coverage` in the table of docs/theory.md, section 8, from what the study has measured.

python -m studies.coverage.row demo/coverage/coverage.json
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

PAGE = Path(__file__).parents[2] / "docs" / "theory.md"
FIRST = "| `make coverage` ("
HEAD = "| components inside [%] / median of bar over error |"


def main(arguments: list[str]) -> None:
    """Write the row, in place of the one that is there."""
    (file,) = arguments
    rows = json.loads(Path(file).read_text(encoding="utf-8"))["rows"]
    PAGE.write_text(with_row(PAGE.read_text(encoding="utf-8"), rows), encoding="utf-8")
    print(PAGE)


def with_row(page: str, rows: list[dict[str, Any]]) -> str:
    """The page with the row of these rows, a model and mesh each, last in its table. Raises SystemExit for a
    page without the table."""
    lines = [line for line in page.splitlines() if not line.startswith(FIRST)]
    try:
        head = next(i for i, line in enumerate(lines) if line.startswith(HEAD))
    except StopIteration:
        raise SystemExit(f"no table begins with {HEAD}") from None
    end = next(i for i in range(head, len(lines)) if not lines[i].startswith("|"))
    wanted = [cell.strip().split(", ") for cell in lines[head].strip("|").split("|")[1:]]
    by_mesh = {(row["model"], str(row["elements"])): row for row in rows}
    cells = [by_mesh.get((model, n)) for model, n in wanted]
    scenes = max(row["scenes"] for row in rows)
    texts = [f"{100.0 * cell['inside']:.1f} / {cell['loose']:.1f}" if cell else "" for cell in cells]
    lines.insert(end, f"{FIRST}{scenes} scenes) | " + " | ".join(texts) + " |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main(sys.argv[1:])
