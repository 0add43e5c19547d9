"""External models: any simulator that answers a static scene can appear in the tables and on the front.

A plug-in is an object with a name, its default settings, and `solve(scene, settings)`. It is selected as a
file, `FILE.py:OBJECT`, where OBJECT is the plug-in or its class, MODEL by default; or by the name under which
a package offers it in the entry-point group `sheetbench.models`:

    [project.entry-points."sheetbench.models"]
    mine = "my_package.my_module:MODEL"

or as a program, `exec:PATH` (`comparisons.external.program`).

`settings` holds the defaults overridden by the user's values (plain JSON data), and no other keys unless the
model has `takes_any`. A ValueError raised by `solve` counts as bad input; a solve that does not converge
reports this in its Solution's status. docs/plugin.py is a short example.
"""

import ast
import re
import sys
from collections.abc import Mapping
from contextlib import suppress
from functools import cache
from hashlib import sha256
from importlib.metadata import EntryPoint, entry_points
from importlib.util import find_spec, module_from_spec, spec_from_file_location
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
OBJECT = "MODEL"  # default name of the model in a file
HINT = (
    "A model of your own is named as FILE.py:CLASS, see docs/plugin.py, as exec:PROGRAM, see docs/strip.sh, "
    "or installed with an entry point"
)


@runtime_checkable
class Model(Protocol):
    """A model outside this package."""

    @property
    def name(self) -> str: ...

    @property
    def settings(self) -> Mapping[str, Any]: ...

    def solve(self, scene: Scene, settings: Mapping[str, Any]) -> Solution:
        """Return the static answer of a scene: displacement in metres at any plan point, and a status."""
        ...


@runtime_checkable
class MovingModel(Model, Protocol):
    """An external model that also simulates motion."""

    def simulate(
        self, scene: Scene, settings: Mapping[str, Any], duration: float, *, every: float
    ) -> History:
        """Return the motion over `duration` [s] from rest, sampled at 0 and then at intervals `every` [s]."""
        ...


def names() -> list[str]:
    """Return the names of the installed plug-ins."""
    return sorted(_entry_points())


def plugin(name: str) -> Model:
    """Return the plug-in of a name or of `FILE.py:OBJECT`. Raises BadInput if it cannot be loaded, is not a
    `Model`, or has a name that is no valid file name."""
    try:
        model = _load(name)
    except (Exception, SystemExit) as error:  # any fault on import is reported with the plug-in's name
        raise BadInput(f"model = '{name}': the plug-in cannot be loaded: {foreign(error)}") from None
    if not isinstance(model, Model):
        raise BadInput(f"model = '{name}': the plug-in lacks a name, settings or solve(scene, settings)")
    if not re.fullmatch(r"\w[\w.+-]*", str(model.name)):
        raise BadInput(f"model = '{name}': its name = '{model.name}': letters, digits and . + - _ alone")
    return model


def moving(name: str) -> MovingModel:
    """Return a plug-in that simulates motion. Raises BadInput for one without `simulate`, and as `plugin`."""
    model = plugin(name)
    if not isinstance(model, MovingModel):
        raise BadInput(f"{name}: has no motion: it lacks simulate(scene, settings, duration, every=…)")
    return model


def from_file(name: str) -> Path | None:
    """Return the file of a model `FILE.py:OBJECT`, None for any other name."""
    file, colon, _ = name.rpartition(":")
    return Path(file) if colon and file.endswith(".py") else None


def is_program(name: str) -> bool:
    """Return whether a model's name stands for a program."""
    return name.startswith(PREFIX)


def is_outside(name: str) -> bool:
    """Return whether a model is selected as a file or a program, and not by an installed name."""
    return is_program(name) or from_file(name) is not None


def shown_name(name: str) -> str:
    """Return a model's name in tables: for a file or a program, the plug-in's own name."""
    return plugin(name).name if is_outside(name) else name


def digest(name: str) -> str | None:
    """Return a digest that identifies a plug-in's version, None for a model that is no plug-in. The digest is
    made from its Python files or its program, and from name and version of its distribution."""
    if is_program(name):
        return Program(name.removeprefix(PREFIX)).digest()
    if (file := from_file(name)) is not None:
        return _digest(_files_of(file))
    if (entry := _entry_points().get(name)) is None:
        return None
    installed = [entry.dist.name, entry.dist.version] if entry.dist is not None else []
    return _digest(_files_of_module(entry.module), *installed)


def answer(model: Model, scene: Scene, settings: Mapping[str, Any]) -> Solution:
    """Return the plug-in's answer. Raises BadInput if the plug-in raises it or tries to end this process."""
    try:
        return model.solve(scene, settings)
    except SystemExit as error:
        raise BadInput(f"{model.name}: the plug-in ends the program, SystemExit({error.code})") from None


def _load(name: str) -> Any:
    """Return the plug-in of a name, file or program; a class is instantiated."""
    if is_program(name):
        return Program(name.removeprefix(PREFIX))
    if from_file(name) is not None:
        return _load_from_file(name)
    model = _entry_points()[name].load()
    return model() if isinstance(model, type) else model


@cache
def _load_from_file(name: str) -> Any:
    """Return the plug-in of `FILE.py:OBJECT`, loaded once per process."""
    file, _, object_name = name.rpartition(":")
    model = getattr(_module(Path(file)), object_name)
    return model() if isinstance(model, type) else model


def _module(file: Path) -> ModuleType:
    """Return a file as a module, which may import modules of its own folder."""
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
    """Return the model's settings, defaults overridden by the given. Raises BadInput for an unknown one."""
    unknown = [key for key in given if key not in model.settings]
    if unknown and not getattr(model, "takes_any", False):
        known = ", ".join(model.settings) or "none"
        raise BadInput(f"model = '{model.name}': no setting '{unknown[0]}'; it has {known}")
    return {**model.settings, **given}


@cache
def _entry_points() -> dict[str, EntryPoint]:
    ours = {name: EntryPoint(name, value, GROUP) for name, value in OURS.items()}
    return {entry.name: entry for entry in entry_points(group=GROUP)} | ours


def _files_of(file: Path) -> dict[str, Path]:
    """Return a file and the modules and packages it imports from its own folder, by their paths there."""
    folder, files, ahead = file.resolve().parent, set[Path](), [file.resolve()]
    while ahead:
        files.add(path := ahead.pop())
        for name in _imported(path):
            own = [folder / f"{name}.py", *(folder / name).rglob("*.py")]
            ahead += [module for module in own if module not in files and module.is_file()]
    return {path.relative_to(folder).as_posix(): path for path in files}


def _imported(file: Path) -> set[str]:
    """Return the first parts of the names of modules that a file imports."""
    names: set[str] = set()
    with suppress(SyntaxError, ValueError):  # reported when it is loaded
        for node in ast.walk(ast.parse(file.read_bytes())):
            if isinstance(node, ast.Import):
                names.update(one.name.partition(".")[0] for one in node.names)
            elif isinstance(node, ast.ImportFrom) and node.module:
                names.add(node.module.partition(".")[0])
    return names


def _files_of_module(name: str) -> dict[str, Path]:
    """Return the files of an installed module's package, or of the module alone, by path as `_files_of`."""
    spec = find_spec(name.partition(".")[0])
    if spec is None or spec.origin is None:
        return {}
    places = spec.submodule_search_locations
    if not places:
        return {Path(spec.origin).name: Path(spec.origin)}
    files = ((Path(place), path) for place in places for path in Path(place).rglob("*.py"))
    return {path.relative_to(place).as_posix(): path for place, path in files}


def _digest(files: Mapping[str, Path], *more: str) -> str:
    """Return a digest of the files' names and contents, and of further texts."""
    lines = [f"{name} {sha256(path.read_bytes()).hexdigest()}" for name, path in sorted(files.items())]
    return sha256("\n".join([*more, *lines]).encode()).hexdigest()
