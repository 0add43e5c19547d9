"""The output of a verb: terminal or JSON document, files in a folder, exit status.

This module alone handles `--json`, `--out`, `--overwrite`, the manifest, warnings and exit status 3.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, NoReturn, TypeVar

import typer

from comparisons.cli import messages, startup
from comparisons.cli.options import CampaignOptions, Group
from sheetbench import clock

if TYPE_CHECKING:
    from comparisons.sweep.folder import Folder
    from sheetbench.answers.answer import Answer
    from sheetbench.answers.figure_style import FigureStyle
    from sheetbench.answers.report import Report, Write
    from sheetbench.scenes import Scene

Shown = TypeVar("Shown", bound="Answer")
NOT_CONVERGED = 3
PICTURES = (".svg", ".png", ".pdf", ".gif")
COMPILED = 5.0  # s: longer compiling is noted; loading kernels takes less


def command_line(verb: str, terminal: bool) -> list[str]:
    """Return the command line of this process for the record of its results."""
    return ["sheetbench", *sys.argv[1:]] if terminal else ["sheetbench", verb, "in Python"]


@dataclass
class Output:
    """The terminal, JSON document and folder of a running verb."""

    options: OutputOptions
    about: Mapping[str, Any]
    folder: Folder | None
    styles: Sequence[FigureStyle]
    store_files: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    spinner: ExitStack = field(default_factory=ExitStack)

    @cached_property
    def progress(self) -> Callable[[Any], None]:
        """The function that shows progress on standard error."""
        if not self.options.terminal:
            from comparisons.models.context import context

            return context().progress
        from comparisons.cli import console  # imports rich, slow for help

        return self.spinner.enter_context(console.progress())

    def keep(self, name: str, write: Write) -> None:
        """Write a file of the answer immediately, if a folder is given."""
        if self.folder is not None:
            self.folder.write(name, write)

    def reserve(self, name: str) -> Path | None:
        """Return the path of a file, or of a folder if the name ends in "/", which the caller writes."""
        return None if self.folder is None else self.folder.reserve(name)

    @contextmanager
    def campaign(self, options: CampaignOptions) -> Iterator[dict[str, Any]]:
        """Yield the keywords of a campaign: store (temporary without folder), workers, pool, progress."""
        from comparisons.sweep.campaign import campaign
        from comparisons.sweep.executors import pool_of
        from comparisons.sweep.store import FILE

        with ExitStack() as stack:
            self.store_files = [FILE]
            yield {
                "store": stack.enter_context(campaign(None if self.folder is None else self.folder.path)),
                "pool": stack.enter_context(pool_of(options.scheduler)),
                "progress": self.progress,
                "workers": options.workers,
                "retry": options.retry,
            }

    def stop(self, complaint: str) -> NoReturn:
        """End the command without an answer: print the reason, also as the document's `stopped`, with exit
        status 3. Raises NoEquilibrium in Python."""
        from comparisons.cli import console
        from sheetbench.errors import NoEquilibrium

        self.spinner.close()
        if not self.options.terminal:
            raise NoEquilibrium(complaint)
        if self.options.json:
            document = {**self.about, "stopped": complaint, "warnings": [complaint, *messages.shown]}
            console.document(document)
        console.warn(complaint)
        raise typer.Exit(NOT_CONVERGED)

    def show(self, answer: Shown, instead: str | None = None) -> Shown:
        """Write the files, print warnings and the document, the tables or the text `instead` of them. Returns
        the answer. Exits with status 3 for an incomplete answer. A call in Python writes the files alone."""
        from comparisons.cli import console

        if not self.options.terminal and self.folder is None:
            return answer
        report = answer.report()
        warnings = report.document.get("warnings", ())  # before warnings about the scene
        document = {**report.document, "warnings": [*warnings, *messages.shown]}
        pictures = () if self.options.no_pictures else report.pictures
        notes = (*report.notes, *self.notes)
        report = replace(report, document=document, pictures=pictures, notes=notes).with_styles(self.styles)
        missing: list[str] = []
        if self.folder is not None:
            missing = [f"No picture: {reason}" for reason in self.folder.report(report, self.progress)]
        self.spinner.close()
        if not self.options.terminal:
            return answer
        if instead is not None:
            print(instead, end="")
        elif self.options.json:
            console.document(report.document)
        else:
            self._print(report)
        for warning in [*missing, *report.complaints]:
            console.warn(warning)
        if not report.succeeded:
            raise typer.Exit(NOT_CONVERGED)
        return answer

    def _print(self, report: Report) -> None:
        from comparisons.cli import console

        console.heading(report.title, report.subtitle)
        if report.lead:
            console.note(report.lead)
        for table in report.shown:
            console.show(table)
            if table.text:
                console.blank()
                console.note(table.text)
        notes = list[str]()
        if (spent := clock.compiled()) > COMPILED:
            notes.append(
                f"Kernels were compiled, once on this machine: {spent:.3g} s, not in the times shown."
            )
        count = len(report.notes) if console.verbose else report.notes_shown
        notes += report.notes[:count]
        if (hidden := len(report.notes) - count) > 0:
            notes.append(f"{hidden} more {'note' if hidden == 1 else 'notes'}: --verbose")
        if self.folder is not None:
            notes.append(self._written())
        if notes and not (report.shown and report.shown[-1].text):
            console.blank()
        for note in notes:
            console.note(note)

    def _written(self) -> str:
        """Return a line with the number of files in the folder; --verbose adds their names."""
        from comparisons.cli import console

        assert self.folder is not None
        written = [*self.folder.written, "manifest.json", *self.store_files]
        names = ", ".join(sorted(written, key=lambda name: not name.endswith(PICTURES)))
        return f"{len(written)} files in {self.folder.path}" + (f": {names}" if console.verbose else "")


@dataclass(frozen=True)
class OutputOptions(Group):
    """Output options of a verb; terminal: whether the command line called it.

    Args:
        out (DIR): Write files into this folder.
        overwrite: First delete the files listed in an earlier run's manifest (with --out).
    """

    no_effect: ClassVar[dict[str, str]] = {"without_out": "overwrite"}
    verb: str
    terminal: bool = True
    json: bool = False
    out: str | None = None
    overwrite: bool = False
    figure: list[str] | None = None
    no_pictures: bool = False

    @property
    def styles(self) -> tuple[FigureStyle, ...]:
        """The styles of pictures. Raises BadInput for unknown formats."""
        from sheetbench.answers.figure_style import parse_figure

        return parse_figure(None if self.figure is None else ",".join(self.figure))

    @contextmanager
    def open(
        self,
        *,
        scene: Scene | None = None,
        about: Mapping[str, Any] | None = None,
        variant: Mapping[str, Any] | None = None,
        locked: bool = False,
    ) -> Iterator[Output]:
        """Open the output of a verb for its answer.

        scene, or about: subject of the answer; variant: options that determine its files; locked: whether to
        lock the folder against other processes (campaigns do this themselves). Raises BadInput for a folder
        that cannot be made or holds unrelated files. A NoEquilibrium in the block stops the command.
        """
        from comparisons.models.context import running
        from sheetbench.errors import NoEquilibrium

        if self.terminal:
            startup.end()
        styles = self.styles
        with ExitStack() as stack:
            folder = None
            if scene is not None:
                about = {"scene": scene.document()}
            if self.out is not None:
                from comparisons.sweep.folder import Folder
                from sheetbench.answers import files
                from sheetbench.files import only_writer

                if locked:
                    stack.enter_context(only_writer(files.folder(self.out)))
                folder = Folder(
                    self.out,
                    self.verb,
                    command_line(self.verb, self.terminal),
                    about=about,
                    variant=variant,
                    overwrite=self.overwrite,
                )
            out = Output(self, about or {}, folder, styles)
            stack.enter_context(out.spinner)
            if self.terminal:
                stack.enter_context(running(progress=out.progress))
            try:
                yield out
            except NoEquilibrium as error:
                out.stop(str(error))


@dataclass(frozen=True)
class PictureOptions(OutputOptions):
    """Output options of a verb that draws pictures.

    Args:
        figure (FORMATS): Pictures for a paper, without a title, as pdf, svg or png (with --out);
            pdf:single,png:single as wide as one column (89 mm), else as both (183 mm).
        no_pictures: Write all files but the pictures (with --out). Every verb accepts it, for scripts.
    """

    no_effect: ClassVar[dict[str, str]] = {
        "without_out": "figure animate",
        "with_no_pictures": "figure animate",
    }
