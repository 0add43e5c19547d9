"""Answers requested more than once."""

from collections.abc import Callable
from typing import Any

from comparisons.models.resolve import Resolved
from sheetbench.answers.solution import Solution


def once(solve: Callable[..., Solution]) -> Callable[..., Solution]:
    """Return the stored answer of an earlier equal question, with or without progress."""
    answers: dict[str, Solution] = {}

    def answer(model: Resolved[Any], *name: str) -> Solution:
        key = f"{model.scene.model_dump_json()} {model.spec!r} {name}"
        if key not in answers:
            answers[key] = solve(model, *name)
        return answers[key]

    return answer
