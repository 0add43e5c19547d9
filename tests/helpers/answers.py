"""Answers asked for more than once."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from sheetbench.scenes import Scene, Solution


def once(ask: Callable[..., Solution]) -> Callable[..., Solution]:
    """A question that was answered before has the same answer, whoever is told of its progress."""
    answers: dict[str, Solution] = {}

    def answer(scene: Scene, model: object, *name: str, **settings: Any) -> Solution:
        asked = sorted((key, value) for key, value in settings.items() if key != "progress")
        key = f"{scene.model_dump_json()} {model} {name} {asked}"
        if key not in answers:
            answers[key] = ask(scene, model, *name, **settings)
        return answers[key]

    return answer
