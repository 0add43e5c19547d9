"""The tasks of campaigns by name: rows are kept under these names, so that moving a file loses no result.

A value is "module:function"; the module is loaded where the task is carried out. The function takes JSON
arguments and returns its row, see `comparisons.runs.campaign.Run`.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any

TASKS = {
    "timing": "comparisons.tradeoff.timing:measure",
    "motion": "comparisons.motion.run:measure",
    "stability.run": "comparisons.stability.tasks:run",
    "crosscheck": "comparisons.crosscheck.task:answer",
}


def function(task: str) -> Callable[..., dict[str, Any]]:
    """Return what a task is carried out by: of a name in `TASKS`, or of "module:function" for one of your
    own."""
    module, _, name = TASKS.get(task, task).partition(":")
    carried_out: Callable[..., dict[str, Any]] = getattr(import_module(module), name)
    return carried_out
