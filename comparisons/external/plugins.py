"""Models from outside: any simulator that answers a static scene can stand in the tables and on the front.

A plug-in is an object with a name, its default settings, and `solve(scene, settings)`. It is requested as a
file, `FILE.py:OBJECT`, where OBJECT is that object or a class of it, MODEL by default; or by its name, which
a package offers under the entry-point group `sheetbench.models`:

    [project.entry-points."sheetbench.models"]
    mine = "my_package.my_module:MODEL"

or as a program, `exec:PATH` (`comparisons.external.program`).

`settings` holds the defaults overridden by what the user asks (plain JSON data), and nothing that the
defaults do not name, unless the model `takes_any`. What `solve` raises as ValueError is bad input; a solve
that does not get there says so in its Solution's status. docs/plugin.py is a short one.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Mapping
from contextlib import suppress
from functools import cache
from hashlib import sha256
from importlib.metadata import EntryPoint, entry_points
from importlib.util import find_spec, module_from_spec, spec_from_file_location
from modulefinder import ModuleFinder
from pathlib import Path
from types import ModuleType
from typing import Any, Protocol, runtime_checkable

from comparisons.external.program import PREFIX, Program
from sheetbench.answers.history import History
from sheetbench.answers.solution import Solution
from sheetbench.errors import BadInput, foreign
from sheetbench.scenes import Scene

GROUP = "sheetbench.models"
OURS = {  # external codes that come with this package
    "calculix": "comparisons.external.calculix.model:MODEL",
    "kratos": "comparisons.external.kratos.model:MODEL",
}
OBJECT = "MODEL"  # what of a file is the model, by default
OWN = (
    "A model of your own is named as FILE.py:CLASS, see docs/plugin.py, as exec:PROGRAM, see docs/strip.sh, "
    "or installed with an entry point"
)


@runtime_checkable
class Model(Protocol):
    """A model of one's own."""

    @property
    def name(self) -> str: ...

    @property
    def settings(self) -> Mapping[str, Any]: ...

    def solve(self, scene: Scene, settings: Mapping[str, Any]) -> Solution:
        """Return the static answer of a scene: displacement in metres at any plan point, and a status."""
        ...


@runtime_checkable
class MovingModel(Model, Protocol):
    """One that answers motions too."""

    def simulate(
        self, scene: Scene, settings: Mapping[str, Any], duration: float, *, every: float
    ) -> History:
        """The motion over `duration` [s] from rest, sampled every so often [s], the start too."""
        ...


def names() -> list[str]:
    """Names of the installed plug-ins."""
    return sorted(_found())


def plugin(name: str) -> Model:
    """Return the plug-in of a name, or of `FILE.py:OBJECT`.

    Raises BadInput if it cannot be loaded, is not a `Model`, or has a name that no file can have.
    """
    try:
        model = _loaded(name)
    except (Exception, SystemExit) as error:  # whatever it does on import, the user learns whose it is
        raise BadInput(f"model = '{name}': the plug-in cannot be loaded: {foreign(error)}") from None
    if not isinstance(model, Model):
        raise BadInput(f"model = '{name}': the plug-in lacks a name, settings or solve(scene, settings)")
    if not re.fullmatch(r"\w[\w.+-]*", str(model.name)):
        raise BadInput(f"model = '{name}': its name = '{model.name}': letters, digits and . + - _ alone")
    return model


def moving(name: str) -> MovingModel:
    """The plug-in of a name. Raises BadInput for one that has no motion, and as `plugin` does."""
    model = plugin(name)
    if not isinstance(model, MovingModel):
        raise BadInput(f"{name}: has no motion: it lacks simulate(scene, settings, duration, every=…)")
    return model


def from_file(name: str) -> Path | None:
    """Return the file of a model `FILE.py:OBJECT`, None of any other name."""
    file, colon, _ = name.rpartition(":")
    return Path(file) if colon and file.endswith(".py") else None


def is_program(name: str) -> bool:
    """Return whether a model is a program."""
    return name.startswith(PREFIX)


def is_outside(name: str) -> bool:
    """Return whether a model is requested as a file or a program, and not by the name that it is installed
    under."""
    return is_program(name) or from_file(name) is not None


def shown_name(name: str) -> str:
    """Return what tables call a model: its plug-in's own name where it was requested as a file or a
    program."""
    return plugin(name).name if is_outside(name) else name


def digest(name: str) -> str | None:
    """Of a plug-in's Python files or its program, and of its distribution's name and version where it is
    installed: with another digest it is another model. None of a model that is no plug-in."""
    if is_program(name):
        return Program(name.removeprefix(PREFIX)).digest()
    if (file := from_file(name)) is not None:
        return _digest(_files_of(file))
    if (entry := _found().get(name)) is None:
        return None
    installed = [entry.dist.name, entry.dist.version] if entry.dist is not None else []
    return _digest(_files_of_module(entry.module), *installed)


def answer(model: Model, scene: Scene, settings: Mapping[str, Any]) -> Solution:
    """Return the plug-in's answer. Raises BadInput where it does instead, or would end this process."""
    try:
        return model.solve(scene, settings)
    except SystemExit as leaving:
        raise BadInput(f"{model.name}: the plug-in ends the program, SystemExit({leaving.code})") from None


def _loaded(name: str) -> Any:
    """Return the object that a name or file stands for; a class is called."""
    if is_program(name):
        return Program(name.removeprefix(PREFIX))
    if from_file(name) is not None:
        return _of_file(name)
    found = _found()[name].load()
    return found() if isinstance(found, type) else found


@cache
def _of_file(name: str) -> Any:
    """Return the object of `FILE.py:OBJECT`, the same throughout a process."""
    file, _, wanted = name.rpartition(":")
    found = getattr(_module(Path(file)), wanted)
    return found() if isinstance(found, type) else found


def _module(file: Path) -> ModuleType:
    """Return the file as a module, which may import what lies beside it."""
    spec = spec_from_file_location(f"sheetbench_plugin_{file.stem}", file)
    if spec is None or spec.loader is None:
        raise BadInput(f"{file}: not a Python file")
    if (folder := str(file.resolve().parent)) not in sys.path:
        sys.path.append(folder)
    module = module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look their module up
    spec.loader.exec_module(module)
    return module


def settings_of(model: Model, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the model's defaults overridden by the request. Raises BadInput for a setting it does not
    have."""
    unknown = [key for key in given if key not in model.settings]
    if unknown and not getattr(model, "takes_any", False):
        known = ", ".join(model.settings) or "none"
        raise BadInput(f"model = '{model.name}': no setting '{unknown[0]}'; it has {known}")
    return {**model.settings, **given}


@cache
def _found() -> dict[str, EntryPoint]:
    ours = {name: EntryPoint(name, value, GROUP) for name, value in OURS.items()}
    return {entry.name: entry for entry in entry_points(group=GROUP)} | ours


def _files_of(file: Path) -> dict[str, Path]:
    """Return a file and what it imports from its own folder, modules and packages, by their paths in
    there."""
    folder = file.resolve().parent
    finder = ModuleFinder(path=[str(folder)])
    with suppress(SyntaxError, ValueError):  # reported when it is loaded
        finder.run_script(str(file.resolve()))
    found = [Path(at) for module in finder.modules.values() if (at := getattr(module, "__file__", None))]
    return {path.relative_to(folder).as_posix(): path for path in {file.resolve(), *found}}


def _files_of_module(name: str) -> dict[str, Path]:
    """Return the package that an installed module is in, or the module alone, as `_files_of` does."""
    spec = find_spec(name.partition(".")[0])
    if spec is None or spec.origin is None:
        return {}
    places = spec.submodule_search_locations
    if not places:
        return _files_of(Path(spec.origin))
    files = ((Path(place), path) for place in places for path in Path(place).rglob("*.py"))
    return {path.relative_to(place).as_posix(): path for place, path in files}


def _digest(files: Mapping[str, Path], *more: str) -> str:
    """Return what follows from the files' names and contents, and from more texts."""
    lines = [f"{name} {sha256(path.read_bytes()).hexdigest()}" for name, path in sorted(files.items())]
    return sha256("\n".join([*more, *lines]).encode()).hexdigest()
