"""`sheetbench report DIR`: one HTML file of all studies in a folder."""

from __future__ import annotations

from pathlib import Path


def command(
    folder: Path,
    *,
    out: Path | None = None,
    open_: bool = False,
    json: bool = False,
) -> Path:
    """Write one HTML file with all runs below a folder.

    The folder and its subfolders are read; a study is the output of a verb with --out, listed in a manifest.
    The page has 3D sheets, sortable tables, figures, notes and manifests, and needs no network.

    Args:
        folder (DIR, argument): A folder with output of verbs (--out).
        out (DIR): Folder of the page, report.html, or FILE.html. Default: DIR.
        open_: Open the page in the browser.
    """
    from webbrowser import open as browse

    from comparisons.cli import console
    from comparisons.pages.studies import read
    from sheetbench.answers.files import folder as made
    from sheetbench.answers.files import write_text
    from sheetbench.errors import BadInput

    try:
        from comparisons.pages.page import memory_of, page
    except ModuleNotFoundError as error:
        raise BadInput(f"report: needs {error.name}; pip install 'sheetbench[report]'") from None
    contents = read(folder)
    if not contents.studies:
        trouble = f"'{folder}': no verb has written here with --out."
        raise BadInput(" ".join([trouble, *contents.troubles[:1]]))
    text = page(contents, folder.resolve().name)
    if out is None or out.suffix != ".html":
        target = (folder if out is None else made(out)) / "report.html"
    else:
        target = out
    write_text(target, text)
    size = target.stat().st_size
    troubles = [*contents.troubles, *(trouble for study in contents.studies for trouble in study.troubles)]
    if json:
        studies = [{"place": s.place, "verb": s.verb, "title": s.title} for s in contents.studies]
        console.document({"file": str(target), "bytes": size, "studies": studies, "troubles": troubles})
    else:
        count = len(contents.studies)
        console.note(f"{count} {'study' if count == 1 else 'studies'} in {target}, {memory_of(size)}")
    if open_ and not browse(target.resolve().as_uri()):
        console.warn("No browser was found: open the page by hand.")
    for trouble in troubles:
        console.warn(trouble)
    return target
