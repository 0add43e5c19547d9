"""The sheets in one HTML file, for any browser and no network; a choice where there are several studies.

What scenes and files say is text: Jinja escapes it, data are read as JSON, and a content security policy lets
the page's own script and style alone do anything.
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib import resources

from jinja2 import Environment, PackageLoader, StrictUndefined

from comparisons.browser import viewer
from comparisons.pages.page import policy
from comparisons.report.escape import terminal
from comparisons.view.staged import Staged

PACKAGE = "comparisons.view"


def page(shown: Sequence[Staged]) -> str:
    """The HTML of these sheets."""
    style, script = viewer.style() + _own("view.css"), viewer.script() + _own("view.js")
    environment = Environment(
        loader=PackageLoader(PACKAGE, "."), autoescape=True, undefined=StrictUndefined, trim_blocks=True
    )
    studies = [
        {"title": terminal(one.title), "subtitle": terminal(one.subtitle), "options": one.options}
        for one in shown
    ]
    return environment.get_template("view.html").render(
        studies=studies, policy=policy(script, style), script=script, style=style
    )


def _own(name: str) -> str:
    return resources.files(PACKAGE).joinpath(name).read_text(encoding="utf-8")
