"""Pages that the documentation's build makes: the studies' tables and every key of a scene."""

from pathlib import Path

from comparisons.models.keys_page import markdown
from comparisons.scoring.suite import Suite
from studies.codes.answer import codes
from studies.pages import kept
from studies.promises.answer import Promises
from studies.promises.expected import expected_errors

KEPT = ("crosscheck", "master-curves", "reproduction", "stability", "transfer")


def write_study_pages(docs: Path) -> None:
    """Write `tables/NAME.md` for every study, and `scene.md`."""
    folder = docs / "tables"
    folder.mkdir(exist_ok=True)
    reports = {name: kept(name) for name in KEPT} | {
        "codes": codes().report(),
        "promises": Promises(tuple(expected_errors()), {}).report(),
        "suite": Suite().report(),
    }
    for name, report in reports.items():
        (folder / f"{name}.md").write_text(report.to_markdown(), encoding="utf-8")
    (docs / "scene.md").write_text(markdown(), encoding="utf-8")
