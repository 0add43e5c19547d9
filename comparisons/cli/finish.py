"""Where the answer of a verb goes: to the terminal or a JSON document, to a folder, and into the exit status.

This module alone knows of `--json`, `--out`, `--overwrite`, the manifest, warnings and exit status 3.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, closing, contextmanager
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import typer

from comparisons.cli import console, warned
from sheetbench import clock

if TYPE_CHECKING:
    from comparisons.report.work import Work
    from comparisons.runs.campaign import Progress
    from comparisons.runs.executors import Pool
    from comparisons.runs.folder import Folder
    from comparisons.runs.store import Store
    from lumped import Calibration
    from sheetbench.answers.figure_style import Look
    from sheetbench.answers.report import Report, Write
    from sheetbench.scenes import Scene

NOT_CONVERGED = 3
COMPILED = 5.0  # s from which on it is said: loading takes less


class End:
    """What a verb may do while it works, and its end when called with the report."""

    def __init__(self, json: bool, folder: Folder | None, look: Look, pictures: bool) -> None:
        self._json = json
        self._folder = folder
        self._look = look
        self._pictures = pictures
        self._also: list[str] = []
        self._spinning = ExitStack()
        self._say: Callable[[Work | str], None] | None = None

    def progress(self, what: Work | str) -> None:
        """Say on standard error what is being done."""
        if self._say is None:
            self._say = self._spinning.enter_context(console.progress())
        self._say(what)

    def keep(self, name: str, write: Write) -> None:
        """Write a file of the answer as soon as it is there, if there is a folder."""
        if self._folder is not None:
            self._folder.write(name, write)

    def export(
        self,
        folder: str | None,
        scene: Scene,
        springs: Calibration,
        report: Report,
        overwrite: bool,
        simulators: Sequence[str] = (),
    ) -> Report:
        """The report, with a note of what was written for other simulators, if there is a folder for them."""
        if folder is None:
            return report
        from comparisons.cli.options import command_line
        from comparisons.export.export import export

        said = export(folder, scene, springs, command_line(), overwrite, simulators)
        return replace(report, notes=(*report.notes, said))

    def place(self, name: str) -> Path | None:
        """The place of a file, or of a folder if the name ends in "/", that a run fills by itself."""
        return None if self._folder is None else self._folder.own(name)

    @contextmanager
    def campaign(
        self, scheduler: str | None = None, wait: bool = False
    ) -> Iterator[tuple[Store, Pool, Callable[[Progress], None]]]:
        """A campaign's store in the folder, or where there is none a passing one; workers; progress.

        scheduler: of a cluster; wait: for workers where it has none, instead of stopping.
        """
        from comparisons.runs.campaign import campaign
        from comparisons.runs.executors import pool_of
        from comparisons.runs.store import FILE

        with ExitStack() as stack:
            if self._folder is None:
                kept = Path(stack.enter_context(TemporaryDirectory()))
            else:
                kept, self._also = self._folder.path, [FILE]
            store = stack.enter_context(campaign(kept))
            pool = stack.enter_context(pool_of(scheduler, wait, console.warn))
            yield store, pool, stack.enter_context(console.campaign_progress())

    def stop(self, complaint: str) -> None:
        """End without an answer, saying why."""
        self.close()
        console.warn(complaint)
        raise typer.Exit(NOT_CONVERGED)

    def __call__(self, report: Report, instead: str | None = None) -> None:
        """Write the files, print the document or the tables or what is wanted `instead` of them, warn, and
        leave with 3 where the question was not met."""
        found = report.document.get("warnings", ())  # the question's own, before those about its scene
        document = {**report.document, "warnings": [*found, *warned.said]}
        pictures = report.pictures if self._pictures else ()
        report = replace(report, document=document, pictures=pictures).dressed(self._look)
        missing: list[str] = []
        if self._folder is not None:
            missing = [f"No picture: {said}" for said in self._folder.report(report, self.progress)]
        self.close()
        if instead is not None:
            print(instead, end="")
        elif self._json:
            console.document(report.document)
        else:
            self._print(report)
        for said in [*missing, *report.complaints]:
            console.warn(said)
        if not report.met:
            raise typer.Exit(NOT_CONVERGED)

    def close(self) -> None:
        """End the spinner."""
        self._spinning.close()
        self._say = None

    def _print(self, report: Report) -> None:
        console.heading(report.title, report.subtitle)
        if report.lead:
            console.note(report.lead)
        for table in report.shown:
            console.show(table)
            if table.text:
                console.note(table.text)
        if (spent := clock.compiled()) > COMPILED:
            console.note(
                f"Kernels were compiled, once on this machine: {spent:.3g} s, in none of the times shown."
            )
        for said in report.notes:  # last: they may end in a command to copy
            console.note(said)
        if self._folder is not None:
            written = [*self._folder.written, "manifest.json", *self._also]
            console.note(f"Files in {self._folder.path}: {', '.join(written)}")


@contextmanager
def finish(
    verb: str,
    json: bool,
    out: str | None,
    overwrite: bool = False,
    *,
    scene: Scene | None = None,
    about: Mapping[str, Any] | None = None,
    apart: Mapping[str, Any] | None = None,
    figure: str | None = None,
    pictures: bool = True,
    alone: bool = False,
) -> Iterator[End]:
    """The end of a verb, to be called with its report.

    scene, or about: what the answer is about; apart: options that decide which files it leaves; figure: the
    look of its pictures; pictures: whether they are drawn; alone: no other process may write to the folder
    meanwhile (campaigns see to that themselves). Raises BadInput for a folder that cannot be had, or that
    holds files of something else.
    """
    from sheetbench.answers.figure_style import parse_figure
    from sheetbench.errors import BadInput

    look = parse_figure(figure)
    if figure is not None and out is None:
        raise BadInput("--figure: needs --out, a folder to draw into")
    if figure is not None and not pictures:
        raise BadInput("--figure: names pictures, and --no-pictures says to draw none; leave one of them out")
    with ExitStack() as held:
        folder = None
        if out is not None:
            from comparisons.cli.options import command_line
            from comparisons.runs.folder import Folder
            from sheetbench.answers import files
            from sheetbench.files import only_writer

            if scene is not None:
                about = {"scene": scene.document()}
            if alone:
                held.enter_context(only_writer(files.folder(out)))
            folder = Folder(out, verb, command_line(), about=about, apart=apart, overwrite=overwrite)
        yield held.enter_context(closing(End(json, folder, look, pictures)))
