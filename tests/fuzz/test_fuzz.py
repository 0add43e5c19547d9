"""Whatever is asked: an exit status, words and numbers as documented, and no file but where it was asked for.

A few hundred examples, the same ones every time; `make fuzz` draws 20 000 others. What a run of it found is
kept in .hypothesis/examples and tried first the next time.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import tomlkit
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from fuzz.grammar import command_lines, measured_files, sound, texts
from fuzz.judge import BAD_INPUT, document, files, held, in_balance, outcome
from sheetbench import scenes

EXAMPLES = int(os.environ.get("FUZZ_EXAMPLES", "0"))  # in all; 0: the few that `make test` tries


def tries(usual: int) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """So many examples in `make test`, their share of 300 in `make fuzz`."""
    few = not EXAMPLES
    return settings(
        max_examples=usual if few else max(1, EXAMPLES * usual // 300),
        derandomize=few,
        database=None if few else settings.default.database,  # type: ignore[union-attr]
        print_blob=True,
        deadline=None,
        suppress_health_check=list(HealthCheck),
        phases=(Phase.explicit, Phase.generate) if few else tuple(Phase),
    )


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("fuzz")


@tries(200)
@given(text=texts())
def test_a_scenes_file_is_read_or_refused_in_a_line(folder: Path, text: bytes) -> None:
    path = folder / "scene.toml"
    path.write_bytes(text)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            scene = scenes.load(path)
    except scenes.SceneError as refused:
        said = str(refused)
        assert said.startswith(str(path)) and "\n" not in said and len(said) < 3000
        assert not any(c < " " or "\x7f" <= c < "\xa0" for c in said), repr(said)
    else:
        assert scenes.Scene.model_validate(scene.document()) == scene


@tries(20)
@given(text=texts())
def test_a_scene_is_checked_and_written_only_where_asked(folder: Path, text: bytes) -> None:
    place = folder / "check"
    place.mkdir(exist_ok=True)
    (place / "scene.toml").write_bytes(text)
    found = outcome(["check", "scene.toml", "--json", "--out", "out"], place)
    held(found, text)
    if found.status != BAD_INPUT:
        document(found)
    assert all(name == "scene.toml" or name.startswith("out/") for name in files(place))


@tries(20)
@given(data=sound())
def test_a_sound_scene_is_solved_and_what_converges_is_in_balance(folder: Path, data: dict[str, Any]) -> None:
    (folder / "sound.toml").write_text(tomlkit.dumps(data), encoding="utf-8")
    small = ("--lumped", "3", "--elements", "2", "--no-uncertainty", "--json")
    found = outcome(["compare", "sound.toml", *small], folder)
    held(found, data)
    if found.status != BAD_INPUT:
        in_balance(document(found))


@tries(30)
@given(asked=command_lines(), json=st.booleans())
def test_a_command_line_is_obeyed_or_refused(folder: Path, asked: list[str], json: bool) -> None:
    place = folder / "commands"
    place.mkdir(exist_ok=True)
    found = outcome([*asked, *(["--json"] if json else [])], place)
    held(found, asked)
    if json and found.status != BAD_INPUT and "--help" not in asked:
        document(found)
    assert not files(place)


@tries(30)
@given(text=measured_files(), moving=st.booleans())
def test_a_measured_file_is_read_or_refused(folder: Path, text: bytes, moving: bool) -> None:
    (folder / "measured.csv").write_bytes(text)
    if moving:
        asked = ["simulate", "two-edges-settling", "--lumped", "2", "--duration", "0.002", "--every", "0.001"]
    else:
        asked = ["identify", "two-edges-clamped", "--lumped", "2"]
    found = outcome([*asked, "--measured", "measured.csv", "--json"], folder)
    held(found, text)
    if found.status != BAD_INPUT:
        document(found)
