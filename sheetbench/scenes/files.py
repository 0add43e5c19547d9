"""Scenes in files: the catalogue that comes with the package, and a user's own TOML files."""

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

MANY = 200  # files in the folder of a missing file that are compared with its name


def catalogue() -> dict[str, Path]:
    """Return the names and files of the scenes that come with the package.

    Returns
    -------
    dict of str to Path
        The TOML file of each scene by its name.
    """
    folder = Path(str(resources.files("sheetbench.scenes") / "catalogue"))
    return {path.stem: path for path in sorted(folder.glob("*.toml"), key=lambda path: path.stem)}


AnyScene = Scene | str | Path


def scene_of(scene: AnyScene) -> Scene:
    """Return a scene as it is, or load it by its catalogue name or its TOML file."""
    return scene if isinstance(scene, Scene) else load(scene)


def load(scene: str | Path) -> Scene:
    """Read a scene from a TOML file or from the catalogue.

    Parameters
    ----------
    scene : str or Path
        A catalogue name or a path.

    Returns
    -------
    Scene
        The scene, validated, in SI units.

    Raises
    ------
    SceneError
        In one line: the file, the key, its value and the allowed values.

    Warns
    -----
    Implausible
        A value that can be solved but is probably a slip, as a length in mm.
    """
    if not isinstance(scene, str | Path):
        raise SceneError(f"scene = {str(scene)[:40]}: a Scene, a name of the catalogue or a path is needed")
    names = catalogue()
    path = names.get(str(scene)) or Path(scene)
    try:
        data = tomllib.loads(read_text(path))
    except FileNotFoundError:
        neighbours = [str(one) for one in sorted(path.parent.glob("*.toml"))[:MANY]]
        near = did_you_mean(str(scene), [*neighbours, *names])
        hint = f"did you mean {near}?" if near else f"the catalogue has {', '.join(names)}"
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
