"""Scenes in files: the catalogue that comes with the package, and TOML files of one's own."""

from __future__ import annotations

import tomllib
from importlib import resources
from pathlib import Path

from pydantic import ValidationError

from sheetbench.errors import BadInput, SceneError, foreign
from sheetbench.scenes.language.reading import read_text
from sheetbench.scenes.language.refusals import did_you_mean, in_one_line
from sheetbench.scenes.meaning.plausibility import warn_of_slips
from sheetbench.scenes.objects.sheet import DRAWN
from sheetbench.scenes.scene import Scene

MANY = 200  # files beside a missing one that are compared with its name


def catalogue() -> dict[str, Path]:
    """Names and files of the scenes that come with the package."""
    folder = Path(str(resources.files("sheetbench.scenes") / "catalogue"))
    return {path.stem: path for path in sorted(folder.glob("*.toml"), key=lambda path: path.stem)}


AnyScene = Scene | str | Path


def scene_of(scene: AnyScene) -> Scene:
    """The scene itself, or that of a catalogue name or a TOML file."""
    return scene if isinstance(scene, Scene) else load(scene)


def load(scene: str | Path) -> Scene:
    """The scene of a catalogue name or of a TOML file.

    Raises SceneError, in one line that names the file, the key, the value and what is allowed. Warns
    (Implausible) of what can be solved and is hardly meant.
    """
    if not isinstance(scene, str | Path):
        raise SceneError(f"scene = {str(scene)[:40]}: a Scene, a name of the catalogue or a path is needed")
    known = catalogue()
    path = known.get(str(scene)) or Path(scene)
    try:
        data = tomllib.loads(read_text(path))
    except FileNotFoundError:
        beside = [str(one) for one in sorted(path.parent.glob("*.toml"))[:MANY]]
        near = did_you_mean(str(scene), [*beside, *known])
        hint = f"did you mean {near}?" if near else f"those are {', '.join(known)}"
        raise SceneError(f"{scene}: no such file, and no catalogue scene of that name; {hint}") from None
    except (OSError, UnicodeDecodeError) as error:
        raise SceneError(f"{scene}: cannot be read as text: {foreign(error)}") from None
    except BadInput as error:
        raise SceneError(str(error)) from None
    except tomllib.TOMLDecodeError as error:
        raise SceneError(f"{scene}: not a TOML file: {foreign(error)}") from None
    except RecursionError:
        raise SceneError(f"{scene}: not a scene: tables or lists within each other without end") from None
    except ValueError:  # from `int`, which TOMLDecodeError does not cover
        raise SceneError(f"{scene}: not a scene: a number of more digits than can be read") from None
    sheet = data.get("sheet")
    for key in DRAWN:
        if isinstance(sheet, dict) and isinstance(sheet.get(key), str):
            sheet[key] = str(path.parent / sheet[key])
    try:
        loaded = Scene.model_validate(data)
    except ValidationError as error:
        raise SceneError(f"{scene}: {in_one_line(error, Scene)}") from None
    warn_of_slips([(str(scene), loaded)], stacklevel=2)
    return loaded
