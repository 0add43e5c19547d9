"""Draw the still pictures of README and of pages in docs, in docs/images: `make pictures`.

    python docs/pictures.py [NAME ...]    all unless named

A PNG says in its description what its numbers are; tests/test_docs.py holds it against the text and a fresh
solve.
"""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from PIL import Image
from PIL.PngImagePlugin import PngInfo

import sheetbench as sb
from sheetbench.answers import style
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
FILM = IMAGES.parents[1] / "examples" / "air" / "film.toml"
MOVED = {"settling": ("two-edges-settling", 1.0, None), "film-in-air": (FILM, 2.0, 1e-6)}  # [s], error
DPI = 170  # 1224 pixels wide


def main(*names: str) -> None:
    """Draw those of these names, all unless any is given."""
    style.DPI = DPI
    with TemporaryDirectory() as folder:
        for name in names or (*COMPARED, *RUBBER, *MOVED):
            if name in MOVED:
                moved, duration, error = MOVED[name]
                run = sb.simulate(sb.load(moved), duration, error=error)
                keep(run.report(), "history.png", Path(folder), name)
            elif name in RUBBER:
                scene = IMAGES.parents[1] / "examples" / "rubber" / f"{name.removeprefix('rubber-')}.toml"
                answer = sb.compare(scene, grid=17, reference="solid", elements=RUBBER[name])
                keep(answer.report(), "comparison.png", Path(folder), name)
            else:
                keep(sb.compare(name).report(), "comparison.png", Path(folder), name)


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
    main(*sys.argv[1:])
