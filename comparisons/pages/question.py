"""Scene and settings of a study, in words."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from comparisons.pages.studies import Study
from sheetbench.answers.table import number, quantity
from sheetbench.scenes.words import in_words

TIMES = ("duration", "step", "largest_step", "every")
UNITS = {"layer_distance": "m", "k": "N/m", **dict.fromkeys(TIMES, "s")}  # of settings


def question(study: Study) -> list[tuple[str, str]]:
    """Pairs of a part's name and what it says: of the scene, then of the settings."""
    scene = study.scene
    parts = study.attempt("scene", lambda: in_words(scene)) if scene is not None else []
    settings = study.run.get("settings")
    chosen = _settings(settings) if isinstance(settings, dict) else []
    return [*(parts or []), *chosen]


def _settings(settings: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Return a line a model, and one for what belongs to none; reasons of choices are among the notes."""
    nested = {k: v for k, v in settings.items() if isinstance(v, dict)}
    flat = {k: v for k, v in settings.items() if k not in nested}
    lines = [(name, _line(values)) for name, values in nested.items() if values]
    return [*lines, ("settings", _line(flat))] if _line(flat) else lines


def _line(values: Mapping[str, Any]) -> str:
    shown = ((key.replace("_", " "), _short(key, value)) for key, value in values.items())
    return ", ".join(f"{key} {value}" for key, value in shown if value and not key.endswith(" reason"))


def _short(key: str, value: Any) -> str:
    """Return a setting in a few characters; nothing of one that is long, which the document has."""
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, int | float) and key in UNITS:
        return quantity(value, UNITS[key])
    if isinstance(value, float):
        return number(value, ".4g")
    if isinstance(value, list) and key == "grids":  # several, and not the sides of one
        return ", ".join(map(str, value))
    if isinstance(value, list) and all(isinstance(one, int) for one in value) and len(value) <= 3:
        return " × ".join(map(str, value))
    return str(value) if isinstance(value, str | int) and len(str(value)) <= 60 else ""
