"""Answers requested more than once."""

from collections.abc import Callable
from typing import Any

from comparisons.models.resolve import Resolved
from sheetbench.answers.solution import Solution


def once(ask: Callable[..., Solution]) -> Callable[..., Solution]:
    """A question that was answered before has the same answer, whoever follows its progress."""
    answers: dict[str, Solution] = {}

    def answer(model: Resolved[Any], *name: str) -> Solution:
        key = f"{model.scene.model_dump_json()} {model.spec!r} {name}"
        if key not in answers:
            answers[key] = ask(model, *name)
        return answers[key]

    return answer
