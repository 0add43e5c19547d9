"""`sheetbench schema`: the scene language as a JSON Schema, or as the reference page."""

from __future__ import annotations

from typing import Annotated

from comparisons.cli.options import option


def command(
    markdown: Annotated[bool, option("Print a page that explains every key instead.")] = False,
) -> None:
    """Print the JSON Schema of a scene, for editors that complete and check TOML files.

    `sheetbench new` leaves it beside the scene, whose first line names it.
    """
    if markdown:
        from sheetbench.scenes.reference import markdown as page

        print(page(), end="")
        return
    from sheetbench.answers.files import to_json
    from sheetbench.scenes import Scene
    from sheetbench.scenes.schema import for_editors

    print(to_json(for_editors(Scene)), end="")
