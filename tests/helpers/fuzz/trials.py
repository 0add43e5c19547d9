"""Trials of one random input: the outcome in a word, or an AssertionError.

Each takes a folder of its own, in which it may write, and what its strategy of `fuzz.grammar` has drawn.
"""

import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import tomlkit
from pydantic import ValidationError

import lumped
from comparisons.models.resolve import resolve
from comparisons.models.spec import Lattice
from fuzz.judge import BAD_INPUT, NOT_CONVERGED, document, files, held, in_balance, outcome
from sheetbench import scenes
from sheetbench.answers.solution import Status

PYDANTIC = {"Input", "tuple", "instance", "dictionary", "constrained", "union"}  # words of its own messages
WORDS = {0: "done", BAD_INPUT: "refused", NOT_CONVERGED: "not converged"}


def reads(folder: Path, text: bytes) -> str:
    """Assert that a scene's file is read, or refused in a line with its name."""
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
        assert not PYDANTIC & {word.strip("':;,.") for word in said.replace("support", "").split()}, said
        return "refused"
    assert scenes.Scene.model_validate(scene.document()) == scene
    return "done"


def checks(folder: Path, text: bytes) -> str:
    """Assert that a scene is checked, and written only to the requested file."""
    (folder / "scene.toml").write_bytes(text)
    found = outcome(["check", "scene.toml", "--json", "--out", "out"], folder)
    held(found, text)
    if found.status != BAD_INPUT:
        document(found)
    assert all(name == "scene.toml" or name.startswith("out/") for name in files(folder))
    return WORDS[found.status]


def compares(folder: Path, data: dict[str, Any]) -> str:
    """Assert that a sound scene is solved, and that a converged answer is in balance."""
    (folder / "scene.toml").write_text(tomlkit.dumps(data), encoding="utf-8")
    small = ("--lumped", "3", "--elements", "2", "--no-uncertainty", "--json")
    found = outcome(["compare", "scene.toml", *small], folder)
    held(found, data)
    if found.status != BAD_INPUT:
        in_balance(document(found))
    return WORDS[found.status]


def solves_shapes(folder: Path, data: dict[str, Any]) -> str:
    """Assert that a scene with shapes is refused in a line, or solved, in balance if it converges."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            scene = scenes.Scene.model_validate(data)
            springs = resolve(scene, Lattice(grid=5)).springs
            found = lumped.solve(scene, springs)
            moved = found.displacement(scene.probe_points())
        except (scenes.BadInput, ValidationError) as refused:
            assert str(refused)
            return "refused"
    if found.status is not Status.CONVERGED:
        return "not converged"
    assert np.isfinite(moved).all() and found.balance is not None and found.balance.holds
    return "done"


def obeys(folder: Path, arguments: Sequence[str]) -> str:
    """Assert that a command line is obeyed or refused, and writes only requested files."""
    found = outcome(arguments, folder)
    held(found, arguments)
    if "--json" in arguments and found.status != BAD_INPUT and "--help" not in arguments:
        document(found)
    assert not files(folder)
    return WORDS[found.status]


STATIC = ("identify", "two-edges-clamped", "--lumped", "2")


def measures(folder: Path, text: bytes) -> str:
    """Assert that a measured file, of a rest or of a motion, is read or refused."""
    (folder / "measured.csv").write_bytes(text)
    found = outcome([*STATIC, "--measured", "measured.csv", "--json"], folder)
    held(found, text)
    if found.status != BAD_INPUT:
        document(found)
    return WORDS[found.status]
