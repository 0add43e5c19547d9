"""Verbs and options that are gone, each with what replaces it."""

from __future__ import annotations

from collections.abc import Sequence

VERBS: dict[str, str] = {}
OPTIONS = {
    ("verify", "--coverage"): "run 'sheetbench study coverage' in a checkout",
}


def refusal(arguments: Sequence[str]) -> str | None:
    """Return the sentence that refuses a verb or option that is gone; None where there is none."""
    verb, *others = arguments or [""]
    if verb in VERBS:
        return f"{verb}: removed; {VERBS[verb]}"
    for option in (other.partition("=")[0] for other in others):
        if (verb, option) in OPTIONS:
            return f"{verb} {option}: removed; {OPTIONS[verb, option]}"
    return None
