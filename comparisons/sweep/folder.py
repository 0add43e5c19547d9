"""The folder of a verb's files, and its manifest: a record of files, scene, options and versions.

A folder holds answers about one scene. A folder with files of another scene, of a verb with another subject,
or of the verb with options that make other files, is refused, because unrelated files would be mixed. The
option `overwrite` first removes the files listed in its manifest, and no others.

The manifest has the record of the latest run and, under "runs", the options and files of every verb. It is
written before the first file, so that files of an interrupted run are listed too.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from comparisons.sweep.manifest import made_with, record
from sheetbench.answers.files import folder, plain, to_json, write_text
from sheetbench.answers.report import Report, Write
from sheetbench.errors import BadInput

MANIFEST = "manifest.json"
ABOUT = ("scene", "sheet", "material")  # keys of a run's subject


class Folder:
    """A folder for the files of one run of a verb.

    about: subject of the run, as {"scene": …}, equal for all runs in a folder; variant: options that
    determine the files, equal for all runs of a verb. Raises BadInput, naming the option, for a folder that
    cannot be made, or that holds other files unless `overwrite` is given.
    """

    def __init__(
        self,
        path: Path | str,
        verb: str,
        command: Sequence[str],
        *,
        about: Mapping[str, Any] | None = None,
        variant: Mapping[str, Any] | None = None,
        overwrite: bool = False,
        option: str = "--out",
    ) -> None:
        self.path = folder(path, option)
        self.written: list[str] = []
        self._overwrite = overwrite
        self._verb = verb
        self._record = record(list(command))
        self._about, self._variant = plain(dict(about or {})), plain(dict(variant or {}))
        self._runs = _runs(self.path, option)
        mixed = {name: keys for name, run in self._runs.items() if (keys := self._differences(name, run))}
        if mixed and not overwrite:
            name, difference = next(iter(mixed.items()))
            raise BadInput(
                f"{option} = '{path}': holds files of another '{name}' (of another {difference}); "
                "choose another folder, or --overwrite"
            )
        self._stale = [name for name in {**mixed, verb: ""} if name in self._runs] if overwrite else []

    def write(self, name: str, write: Write) -> None:
        """Write a file of the run, after an entry in the manifest."""
        self.reserve(name)
        write(self.path / name)

    def reserve(self, name: str) -> Path:
        """List a file, or a folder if its name ends in "/", as this run's, and return its path. Raises
        BadInput for an existing file that no run wrote, unless it may be overwritten."""
        self._clear()
        if name not in self.written:
            known = any(name in run["files"] for run in self._runs.values())
            if not (known or self._overwrite) and (self.path / name).exists():
                raise BadInput(f"{self.path / name}: no run wrote it; move it, or --overwrite replaces it")
            self.written.append(name)
            self.note()
        return self.path / name

    def report(self, report: Report, progress: Callable[[str], None] = lambda text: None) -> list[str]:
        """Write the missing files of a report; return a sentence with the reason for each missing figure."""
        for name, write in report.files(made_with()).items():
            if name not in self.written:
                self.write(name, write)
        missing = []
        for picture in report.pictures:
            progress(f"drawing {picture.names[0]} …")
            for name in picture.names:
                self.reserve(name)
            if reason := picture.write(self.path):
                missing.append(reason)
                self.written = [name for name in self.written if name not in picture.names]
        self.note(report.settings, report.words())
        return missing

    def _clear(self) -> None:
        """Remove the files of runs that this run replaces; called when it has its first file."""
        for verb in self._stale:
            for name in self._runs.pop(verb)["files"]:
                _remove(self.path, name)
        self._stale = []

    def note(self, settings: Mapping[str, Any] | None = None, words: Mapping[str, Any] | None = None) -> None:
        """Write the manifest; settings, words: of the run, once all its files are written."""
        self._clear()
        others = {
            verb: {**run, "files": [name for name in run["files"] if name not in self.written]}
            for verb, run in self._runs.items()
        }
        earlier = others.pop(self._verb, {"files": []})["files"]
        this_run = {
            "command": self._record["command"],
            "date": self._record["date"],
            "finished": settings is not None,
            "asked": self._variant,
            "files": [*self.written, *(name for name in earlier if (self.path / name).exists())],
            **self._about,
            **({} if words is None else {"words": words, "settings": settings}),
        }
        made_with_settings = {} if settings is None else {"settings": settings}
        runs = {**others, self._verb: this_run}
        manifest = {**self._record, **made_with_settings, **self._about, "runs": runs}
        write_text(self.path / MANIFEST, to_json(manifest))

    def _differences(self, verb: str, run: Mapping[str, Any]) -> str:
        """Return the names of differences in subject or options between an earlier run and this one."""
        earlier, present = ({**about.get("scene", {}), **about} for about in (run, self._about))
        shared = [key for key in ABOUT if key in earlier and key in present]
        if not shared and verb != self._verb:
            return "question"
        pairs = {key: (earlier[key], present[key]) for key in shared}
        if verb == self._verb:
            options = {**run["asked"], **self._variant}
            pairs |= {name: (run["asked"].get(name), self._variant.get(name)) for name in options}
        return ", ".join(name for name, (old, new) in pairs.items() if old != new)


def _runs(path: Path, option: str) -> dict[str, Any]:
    """Return the runs in the manifest of a folder, by verb. Raises BadInput for another kind of file."""
    try:
        manifest = json.loads((path / MANIFEST).read_text(encoding="utf-8"))
        return {verb: {"files": [], "asked": {}, **run} for verb, run in manifest["runs"].items()}
    except FileNotFoundError:
        return {}
    except (OSError, ValueError, AttributeError, TypeError, LookupError):
        raise BadInput(f"{option} = '{path}': its {MANIFEST} cannot be read; choose another folder") from None


def _remove(path: Path, name: str) -> None:
    """Remove a listed file and folders left empty by it; nothing outside `path` is removed."""
    target = path / name
    if not target.parent.resolve().is_relative_to(path.resolve()):
        return
    if name.endswith("/") and _is_folder(target):
        for run in filter(_is_folder, target.iterdir()):  # one of several runs that stream there
            _remove(target, f"{run.name}/")
        for file in target.iterdir():
            if not _is_folder(file):
                file.unlink()
    elif not target.is_dir():
        target.unlink(missing_ok=True)
    for parent in [target, *target.parents]:
        if parent == path or (parent.is_dir() and any(parent.iterdir())):
            break
        if parent.is_dir():
            parent.rmdir()


def _is_folder(path: Path) -> bool:
    return path.is_dir() and not path.is_symlink()
