"""`sheetbench study expected-errors`: the expected error of a lattice's grid beside the true one."""

from __future__ import annotations

import json
import warnings
from typing import Annotated

from comparisons.cli import console
from comparisons.cli.options import option
from studies.expected_errors.study import STORED, measure, scenes, table


def command(anew: Annotated[bool, option("Solve all scenes again.", None, "--anew")] = False) -> None:
    """Solve what is not stored yet, and print the table of docs/theory.md."""
    warnings.simplefilter("ignore")
    rows = json.loads(STORED.read_text()) if STORED.exists() and not anew else {}
    for name, (group, scene) in scenes().items():
        if name not in rows:
            console.tell(f"solving {name} …")
            rows[name] = measure(group, scene)
            STORED.write_text(json.dumps(rows, separators=(",", ":")).replace('},"', '},\n"') + "\n")
    print(table(rows))
