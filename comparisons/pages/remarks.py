"""Notes and warnings of a run, beside its tables and figures."""

from __future__ import annotations

from typing import Any

from comparisons.pages.studies import Study


def notes(study: Study) -> list[str]:
    """Return the notes of a run on one line each; one that ends in a colon with what follows it."""
    found: list[str] = []
    for note in study.words.get("notes") or texts(study.document.get("notes")):
        line = " ".join(note.split())
        if found and found[-1].endswith(":"):
            found[-1] += f" {line}"
        else:
            found.append(line)
    return found


def complaints(study: Study) -> list[str]:
    """Return what went wrong, and what is doubtful about the scene."""
    return list(dict.fromkeys([*study.words.get("complaints", ()), *texts(study.document.get("warnings"))]))


def texts(value: Any) -> list[str]:
    """Return the texts of a document's list; none where it is something else."""
    return [str(one) for one in value] if isinstance(value, list) else []
