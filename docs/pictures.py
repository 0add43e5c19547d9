"""Draw the still pictures of README and of pages in docs, in docs/images: `make pictures`, or those named.

A PNG says in its description what its numbers are; tests/test_docs.py holds it against the text and a fresh
solve.
"""

import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from PIL import Image
from PIL.PngImagePlugin import PngInfo

import sheetbench as sb
from sheetbench.answers import style
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import Report

IMAGES = Path(__file__).parent / "images"
COMPARED = (
    "two-edges-clamped",
    "one-edge-clamped",
    "fabric-square",
    "ray-fin",
    "kirigami-strip",
    "pouch",
    "gripper-finger",
    "curved-edge",
    "curved-edge-down",
    "actuated-edge",
    "bimetal-strip",
    "muscle-bands",
    "bistable-bilayer",
    "heated-plate",
    "strip-on-table",
    "napkin-on-ball",
    "finger-on-cylinder",
)
RUBBER = {"rubber-inflated-square": 12, "rubber-strip": 6}  # scenes of examples/rubber, elements of the solid
DPI = 170  # 1224 pixels wide


FILM = IMAGES.parents[1] / "examples" / "air" / "film.toml"
MOVED: dict[str, tuple[str | Path, float, float | None]] = {  # scene, duration [s], error of a step
    "settling": ("two-edges-settling", 1.0, None),
    "film-in-air": (FILM, 2.0, 1e-6),
}
STILL, MOVING = "comparison.png", "history.png"


def answers() -> dict[str, tuple[Callable[[], Answer], str]]:
    """Return what finds the answer of every picture, and which of its files the picture is, by its name."""

    def rubber(name: str, elements: int) -> Answer:
        scene = IMAGES.parents[1] / "examples" / "rubber" / f"{name.removeprefix('rubber-')}.toml"
        return sb.compare(scene, grid=17, reference="solid", elements=elements)

    def moved(scene: str | Path, duration: float, error: float | None) -> Answer:
        return sb.simulate(sb.load(scene), duration, error=error)

    return {
        **{name: (partial(sb.compare, name, uncertainty=False), STILL) for name in COMPARED},
        **{name: (partial(rubber, name, elements), STILL) for name, elements in RUBBER.items()},
        **{name: (partial(moved, *given), MOVING) for name, given in MOVED.items()},
    }


def main(names: list[str]) -> None:
    """Draw those named, or all of them."""
    style.DPI = DPI
    with TemporaryDirectory() as folder:
        for name, (answer, drawn) in answers().items():
            if name in names or not names:
                keep(answer().report(), drawn, Path(folder), name)


def keep(answer: Report, drawn: str, folder: Path, name: str) -> None:
    """Draw one picture of an answer; keep it as a small file with its description."""
    (picture,) = (one for one in answer.pictures if drawn in one.names)
    if refusal := picture.write(folder):
        raise SystemExit(refusal)
    with Image.open(folder / drawn) as image:
        words = PngInfo()
        for key, text in image.text.items():
            words.add_text(key, text)
        image.convert("RGB").save(IMAGES / f"{name}.png", optimize=True, pnginfo=words)
    print(IMAGES / f"{name}.png")


if __name__ == "__main__":
    main(sys.argv[1:])
