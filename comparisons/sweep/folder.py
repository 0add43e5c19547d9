"""The folder that a verb's files go to, and its manifest: what is there, of which scene, made with what.

A folder holds answers about one scene. Files of another scene, of another verb that is about no scene or
sheet in common, or of the same verb with options that leave other files, would stand side by side
with new ones as if they belonged together: such a folder is refused, and with `overwrite` cleared first, of
the files that its manifest lists and of nothing else.

The manifest says what the latest run was made with, and under "runs", for every verb, its options and
which files are its own. It is written before the first file is whole, so that what an interrupted run leaves
is known too.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from comparisons.sweep.manifest import made_with, record
from sheetbench.answers.files import folder, plain, to_json, write_text
from sheetbench.answers.report import Report, Write
from sheetbench.errors import BadInput

MANIFEST = "manifest.json"
ABOUT = ("scene", "sheet", "material")  # what a run is about


class Folder:
    """A folder for the files of one run of a verb.

    about: what the run is about, as {"scene": …}, the same for all runs in a folder. variant: options that
    decide which files there are, the same for all runs of a verb. Raises BadInput for a folder that cannot
    be made, or that holds something else, unless `overwrite`, naming the option.
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
        mixed = {name: off for name, run in self._runs.items() if (off := self._differences(name, run))}
        if mixed and not overwrite:
            name, difference = next(iter(mixed.items()))
            raise BadInput(
                f"{option} = '{path}': holds files of another '{name}' (of another {difference}); "
                "choose another folder, or --overwrite"
            )
        self._stale = [name for name in {**mixed, verb: ""} if name in self._runs] if overwrite else []

    def write(self, name: str, write: Write) -> None:
        """Write a file of the run; its name is in the manifest first."""
        self.reserve(name)
        write(self.path / name)

    def reserve(self, name: str) -> Path:
        """Return the path of a file, or of a folder if its name ends in "/", and list it as this run's.

        Raises BadInput where one that no run wrote stands there, unless it may be overwritten.
        """
        self._clear()
        if name not in self.written:
            known = any(name in run["files"] for run in self._runs.values())
            if not (known or self._overwrite) and (self.path / name).exists():
                raise BadInput(f"{self.path / name}: not of a run here; move it, or --overwrite replaces it")
            self.written.append(name)
            self.note()
        return self.path / name

    def report(self, report: Report, progress: Callable[[str], None] = lambda text: None) -> list[str]:
        """Write what of a report is not there yet; sentences that say why a picture is missing."""
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
        """Remove the files of runs that this one takes the place of, once there is something to put there."""
        for verb in self._stale:
            for name in self._runs.pop(verb)["files"]:
                _remove(self.path, name)
        self._stale = []

    def note(self, settings: Mapping[str, Any] | None = None, words: Mapping[str, Any] | None = None) -> None:
        """Write the manifest; with what the run was made with, and its words, once it has left all its
        files."""
        self._clear()
        of_others = {
            verb: {**run, "files": [name for name in run["files"] if name not in self.written]}
            for verb, run in self._runs.items()
        }
        earlier = of_others.pop(self._verb, {"files": []})["files"]
        mine = {
            "command": self._record["command"],
            "date": self._record["date"],
            "finished": settings is not None,
            "asked": self._variant,
            "files": [*self.written, *(name for name in earlier if (self.path / name).exists())],
            **self._about,
            **({} if words is None else {"words": words, "settings": settings}),
        }
        made_with_settings = {} if settings is None else {"settings": settings}
        whole = {**self._record, **made_with_settings, **self._about, "runs": {**of_others, self._verb: mine}}
        write_text(self.path / MANIFEST, to_json(whole))

    def _differences(self, verb: str, run: Mapping[str, Any]) -> str:
        """Return by what the scene or options of a run that left files here are others than this run's."""
        there, here = ({**of.get("scene", {}), **of} for of in (run, self._about))
        shared = [key for key in ABOUT if key in there and key in here]
        if not shared and verb != self._verb:
            return "question"
        pairs = {key: (there[key], here[key]) for key in shared}
        if verb == self._verb:
            options = {**run["asked"], **self._variant}
            pairs |= {name: (run["asked"].get(name), self._variant.get(name)) for name in options}
        return ", ".join(name for name, (theirs, ours) in pairs.items() if theirs != ours)


def _runs(path: Path, option: str) -> dict[str, Any]:
    """Return what the manifest of a folder lists, by verb. Raises BadInput for a file that is none of
    ours."""
    try:
        manifest = json.loads((path / MANIFEST).read_text(encoding="utf-8"))
        return {verb: {"files": [], "asked": {}, **run} for verb, run in manifest["runs"].items()}
    except FileNotFoundError:
        return {}
    except (OSError, ValueError, AttributeError, TypeError, LookupError):
        raise BadInput(f"{option} = '{path}': its {MANIFEST} cannot be read; choose another folder") from None


def _remove(path: Path, name: str) -> None:
    """Remove a file that the manifest lists, and the folders that are empty without it; never outside."""
    place = path / name
    if not place.parent.resolve().is_relative_to(path.resolve()):
        return
    if name.endswith("/") and _own(place):
        for run in filter(_own, place.iterdir()):  # one of several that stream there
            _remove(place, f"{run.name}/")
        for file in place.iterdir():
            if not _own(file):
                file.unlink()
    elif not place.is_dir():
        place.unlink(missing_ok=True)
    for emptied in [place, *place.parents]:
        if emptied == path or (emptied.is_dir() and any(emptied.iterdir())):
            break
        if emptied.is_dir():
            emptied.rmdir()


def _own(place: Path) -> bool:
    return place.is_dir() and not place.is_symlink()
