"""The sheets in a window of pyvista: turned by the mouse, chosen and moved through time by sliders.

It shows what the viewer of the pages shows, of the same data (`comparisons.browser.sheets`).
"""

from __future__ import annotations

import os
import sys
from base64 import b64decode
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, cast

import numpy as np
import pyvista

from comparisons.view.staged import Staged

SECONDS = 4.0  # that a motion takes to watch
MAPS = {"magnitude": "viridis", "signed": "RdBu_r", "difference": "magma_r"}
LINKS = {"lines": ("#4b525a", 2.0, 1.0), "faint": ("#80868e", 1.0, 0.35), "strong": ("#c8553d", 4.0, 1.0)}


def display_there() -> bool:
    """Whether this system can open windows."""
    return sys.platform in ("win32", "darwin") or any(map(os.environ.get, ("DISPLAY", "WAYLAND_DISPLAY")))


class Window:
    """Sheets of studies in one window, a view at a time."""

    def __init__(self, shown: Sequence[Staged], off_screen: bool = False) -> None:
        self.plotter = cast(Any, pyvista.Plotter(off_screen=off_screen, title="sheetbench view"))
        self._studies = [(staged, view) for staged in shown for view in staged.options["views"]]
        self._actors: list[Any] = []
        labels = [_label(staged, view, len(shown) > 1) for staged, view in self._studies]
        self.view(0)
        if len(labels) > 1:
            self.plotter.add_text_slider_widget(
                lambda label: self.view(labels.index(label)),
                labels,
                value=0,
                pointa=(0.03, 0.94),
                pointb=(0.4, 0.94),
            )
        times = self.times
        if len(times) > 1:
            ends = (times[0], times[-1])
            self.plotter.add_slider_widget(
                self.time,
                ends,
                value=times[-1],
                title="time [s]",
                pointa=(0.6, 0.94),
                pointb=(0.97, 0.94),
                style="modern",
            )
            every = max(10, round(1e3 * SECONDS / len(times)))
            self.plotter.add_timer_event(len(times), every, lambda step: self.time(times[step % len(times)]))
        self.plotter.show_axes()
        heading = self._studies[0][1].get("from") or shown[0].options.get("from") or (0.75, -1.0, 0.55)
        self.plotter.view_vector(heading, viewup=(0.0, 0.0, 1.0))

    @property
    def times(self) -> list[float]:
        """Moments [s] of all motions, rising."""
        sheets = (sheet for staged, _ in self._studies for sheet in staged.options["sheets"])
        return sorted({frame["time"] for sheet in sheets for frame in sheet.get("frames", ())})

    def view(self, number: int) -> None:
        """Show a view, as all motions are at the end."""
        self._number, self._time = number, np.inf
        self._draw()

    def time(self, seconds: float) -> None:
        """Show every motion as it is at a time [s]."""
        self._time = seconds
        self._draw()

    def show(self) -> None:
        """Open the window, until it is closed."""
        self.plotter.show()

    def _draw(self) -> None:
        for actor in self._actors:
            self.plotter.remove_actor(actor, render=False)
        staged, view = self._studies[self._number]
        sheets = [sheet for sheet in staged.options["sheets"] if sheet["name"] in view["sheets"]]
        wanted = view.get("field", "")
        lows, highs = zip(*(_limits(sheet, wanted) for sheet in sheets), strict=True)
        limits = (min(lows), max(highs))
        self._actors = [actor for sheet in sheets for actor in self._sheet(sheet, wanted, limits)]
        self.plotter.render()

    def _sheet(self, sheet: Mapping[str, Any], wanted: str, limits: tuple[float, float]) -> Iterable[Any]:
        """A sheet coloured by a field; limits: of its values in the view, at any time."""
        u = _at_time(sheet, self._time).reshape(-1, 3)
        points = unpacked(sheet["points"]).reshape(-1, 3) + u
        field = _field(sheet, wanted)
        label = f"{field['label']} [{field['unit']}]" if field.get("unit") else field["label"]
        cmap = MAPS[field.get("kind", "magnitude")]
        colours = {"scalars": _values(field, u), "cmap": cmap, "clim": limits, "render": False}
        colours |= {"scalar_bar_args": {"title": f"{label}\n", "n_labels": 5, "fmt": "%.3g"}}
        faces = [_cells(unpacked(sheet[name]), n) for name, n in _FACES.items() if name in sheet]
        if any(len(cells) for cells in faces):
            surface = pyvista.PolyData(points, faces=np.concatenate(faces))
            yield self.plotter.add_mesh(surface, name=f"{sheet['name']} surface", **colours)
        else:
            yield self.plotter.add_mesh(
                pyvista.PolyData(points), name=f"{sheet['name']} masses", style="points", point_size=11.0,
                render_points_as_spheres=True, **colours,
            )  # fmt: skip
        for name, (colour, width, opacity) in LINKS.items():
            if len(pairs := unpacked(sheet[name])):
                lines = pyvista.PolyData(points, lines=_cells(pairs, 2))
                yield self.plotter.add_mesh(
                    lines, name=f"{sheet['name']} {name}", color=colour, line_width=width, opacity=opacity,
                    render=False,
                )  # fmt: skip


_FACES = {"quads": 4, "triangles": 3}


def unpacked(numbers: Mapping[str, str]) -> np.ndarray:
    """The numbers that `comparisons.browser.sheets.packed` has packed, (n,)."""
    ((kind, text),) = numbers.items()
    found: np.ndarray = np.frombuffer(b64decode(text), dtype=f"<{kind[0]}4")
    return found.astype(float if kind == "float32" else int)


def _label(staged: Staged, view: Mapping[str, Any], several: bool) -> str:
    label = str(view.get("label") or view["name"])
    return f"{staged.title}: {label}" if several else label


def _at_time(sheet: Mapping[str, Any], time: float) -> np.ndarray:
    """The displacement of a sheet at a time: of its last moment before, or of its first."""
    frames = sheet.get("frames", ())
    if not frames:
        return unpacked(sheet["displacement"])
    before = [frame for frame in frames if frame["time"] <= time]
    return unpacked((before[-1] if before else frames[0])["displacement"])


def _field(sheet: Mapping[str, Any], wanted: str) -> dict[str, Any]:
    """The field of a name, or the sheet's first."""
    found: dict[str, Any] = next((f for f in sheet["fields"] if f["name"] == wanted), sheet["fields"][0])
    return found


def _values(field: Mapping[str, Any], u: np.ndarray) -> np.ndarray:
    """Values of a field in its unit: its own, or a component or the length of the displacement (n, 3) [m]."""
    if "values" in field:
        found = unpacked(field["values"])
    else:
        component = field.get("component")
        found = u[:, "xyz".index(component)] if component else np.linalg.norm(u, axis=1)
    scaled: np.ndarray = field.get("scale", 1.0) * found
    return scaled


def _limits(sheet: Mapping[str, Any], wanted: str) -> tuple[float, float]:
    """The ends of a field's colours, over all moments, so that they keep their meaning. Zero is within;
    it is the middle of a field that has a sign."""
    field, moments = _field(sheet, wanted), [sheet, *sheet.get("frames", ())]
    moved = (unpacked(moment["displacement"]).reshape(-1, 3) for moment in moments)
    values = np.concatenate([_values(field, u) for u in moved])
    low, high = float(values.min(initial=0.0)), float(values.max(initial=0.0))
    if field.get("kind") == "signed":
        low, high = min(low, -high), max(high, -low)
    return low, high if high > low else low + 1.0


def _cells(numbers: np.ndarray, corners: int) -> np.ndarray:
    """Cells as VTK lists them: how many points, then which."""
    cells = numbers.reshape(-1, corners)
    return np.column_stack([np.full(len(cells), corners), cells]).ravel()
