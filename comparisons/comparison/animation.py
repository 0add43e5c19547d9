"""Animation of sheets at true scale: frames with time and colour bar, as a GIF of 480 pixels below 1 MB."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from comparisons.comparison.figure import HEIGHTS, colour_bar
from comparisons.comparison.frames import Frame, frames
from comparisons.pictures import offscreen
from comparisons.pictures.plan import plan_mesh
from comparisons.pictures.stage import Stage
from sheetbench.answers.history import History
from sheetbench.answers.report import NoPicture
from sheetbench.answers.style import STYLE, plain
from sheetbench.files import replacing
from sheetbench.scenes import Scene

WIDTH, PER_INCH = 4.0, 160  # inches, pixels per inch
COLOURS, PIXELS = 64, 480  # of a GIF: its palette, its width
SURFACE_LINES = 8  # cells drawn on a reference's sheet along its shorter side
PER_SECOND, MOST = 8, 34  # frames per second, largest number of frames


def animate(scene: Scene, histories: Sequence[History], paths: Sequence[Path]) -> None:
    """Write the frames of runs as GIF to every path, several runs side by side with their labels. Raises
    NoPicture without off-screen drawing."""
    if reason := offscreen.unavailable_reason():
        raise NoPicture(reason)
    labels = [history.label for history in histories] if len(histories) > 1 else [""]
    images = _images(scene, [frames(history) for history in histories], labels)
    for path in paths:
        with replacing(path) as partial:
            _write_gif(partial, images)


def _images(
    scene: Scene, runs: Sequence[Sequence[tuple[float, Frame]]], labels: Sequence[str]
) -> list[Image.Image]:
    """Return an image per time from the frames of one or several runs; labels: of the runs."""
    moments = list(zip(*runs, strict=False))
    moments = moments[:: -(-len(moments) // MOST)]
    plan = plan_mesh(scene, 16).points[:, :2]
    flat = np.column_stack([plan, np.zeros(len(plan))])
    all_frames = [frame for moment in moments for _, frame in moment]
    sheets = [flat + frame.displacement(plan) for frame in all_frames]
    seen = np.vstack([flat, *sheets, *(rest + u for frame in all_frames for rest, u in frame.axes)])
    heights = [1e3 * (sheet - flat)[:, 2] for sheet in sheets]
    heights += [1e3 * frame.mesh.point_data["displacement"][:, 2] for frame in all_frames]
    limits = (min(float(h.min()) for h in heights), max(float(h.max()) for h in heights) + 1e-9)
    speed = (moments[-1][0][0] - moments[0][0][0]) * PER_SECOND / max(len(moments) - 1, 1)
    images = []
    for moment in moments:
        views = [_view(scene, time, frame, limits, seen, len(moment)) for time, frame in moment]
        caption = f"t = {moment[0][0]:.3f} s   (shown at {speed:.2g} × real time)"
        images.append(_page(scene, list(zip(views, labels, strict=True)), caption, limits))
    return images


def _view(
    scene: Scene, time: float, frame: Frame, limits: tuple[float, float], seen: np.ndarray, columns: int
) -> np.ndarray:
    """Return the pixels of a sheet and its obstacles; columns: number of views side by side."""
    solution: Any = frame
    stage = Stage(scene, solution, 1.0, pixels=round(1.5 * WIDTH * PER_INCH / columns))
    if frame.of_lattice:
        stage.lattice(frame.mesh, 1e3 * frame.mesh.point_data["displacement"][:, 2], limits, HEIGHTS)
    else:
        plan = plan_mesh(scene).points[:, :2]
        stage.surface(solution, 1e3 * frame.displacement(plan)[:, 2], limits, HEIGHTS, SURFACE_LINES)
    for rest, u in frame.axes:
        stage.chain(rest + u)
    return stage.take(np.vstack([seen, stage.obstacles(time)]), np.empty((0, 3)))[0]


def _page(
    scene: Scene, views: Sequence[tuple[np.ndarray, str]], caption: str, limits: tuple[float, float]
) -> Image.Image:
    """Return an image of views with their labels, title, caption and colour bar."""
    title = plain(scene.title or scene.name, width=72)
    top, bottom = 0.19 + 0.15 * len(title.splitlines()), 0.42
    pixels = views[0][0]
    height = WIDTH / len(views) * pixels.shape[0] / pixels.shape[1] + top + bottom
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(WIDTH, height), dpi=PER_INCH, facecolor="white")
        share = 1.0 / len(views)
        for number, (view, label) in enumerate(views):
            panel = figure.add_axes((number * share, bottom / height, share, 1.0 - (top + bottom) / height))
            panel.imshow(view, interpolation="lanczos")
            panel.set_axis_off()
            figure.text(
                (number + 0.5) * share, bottom / height, label, ha="center", va="bottom", fontsize=6.5
            )
        figure.text(0.02, 1.0 - 0.04 / height, title, va="top")
        figure.text(0.02, 1.0 - (top - 0.15) / height, caption, va="top", fontsize=6.5)
        bar = figure.add_axes((0.25, 0.28 / height, 0.5, 0.07 / height))
        colour_bar(figure, HEIGHTS, limits, "$u_z$  [mm]", cax=bar)
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
    return Image.fromarray(np.asarray(canvas.buffer_rgba())[:, :, :3].copy())


def _write_gif(path: Path, images: list[Image.Image]) -> None:
    size = (PIXELS, round(PIXELS * images[0].height / images[0].width))
    images = [image.resize(size, Image.Resampling.LANCZOS) for image in images]
    # One palette and no dither: still parts have equal pixels in all frames, so the file stays small.
    samples = images[::8]
    column = Image.new("RGB", (samples[0].width, sum(image.height for image in samples)))
    for number, image in enumerate(samples):
        column.paste(image, (0, number * image.height))
    palette = column.quantize(COLOURS, method=Image.Quantize.MAXCOVERAGE)
    reduced = [image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images]
    reduced[0].save(
        path,
        save_all=True,
        append_images=reduced[1:],
        duration=1000 // PER_SECOND,
        loop=0,
        optimize=True,
        format="GIF",
    )
