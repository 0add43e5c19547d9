"""`sheetbench study expected-errors`: the expected error of a lattice's grid beside the true one."""

from __future__ import annotations

import json
import warnings
from typing import Annotated

import typer

from comparisons.cli import console
from studies.expected_errors.study import STORED, measure, scenes, table


def command(
    anew: Annotated[bool, typer.Option("--anew", help="Solve all scenes again.")] = False,
) -> None:
    """Solve what is not stored yet, and print the table of docs/theory.md."""
    warnings.simplefilter("ignore")
    rows = json.loads(STORED.read_text()) if STORED.exists() and not anew else {}
    for name, (group, scene) in scenes().items():
        if name not in rows:
            console.tell(f"solving {name} …")
            rows[name] = measure(group, scene)
            STORED.write_text(json.dumps(rows, separators=(",", ":")).replace('},"', '},\n"') + "\n")
    print(table(rows))
