"""Spring constants for a sheet, as tables and as the [springs] table of a scene."""

from __future__ import annotations

import json
from functools import partial
from math import inf
from typing import TYPE_CHECKING, Any

from comparisons.calibration import damping
from sheetbench.answers.files import write_text
from sheetbench.answers.report import Report
from sheetbench.answers.table import Column, Table
from sheetbench.scenes.grading import of_settings
from sheetbench.scenes.summary import few
from sheetbench.scenes.words import sheet_in_words

if TYPE_CHECKING:
    from comparisons.calibration.damping import ModeDamping
    from comparisons.models.expected_error import ExpectedError
    from lumped import Calibration
    from sheetbench.scenes import Material, Sheet


def report(
    calibration: Calibration,
    sheet: Sheet,
    material: Material,
    expected: ExpectedError | None = None,
    damped: tuple[ModeDamping, ...] = (),
) -> Report:
    """What `sheetbench calibrate` shows of the springs for a sheet; expected: their error in a scene; damped:
    its lowest modes."""
    found = document(calibration) | ({"expected_error": expected.as_dict()} if expected else {})
    found |= damping.document(material, damped)
    nx, ny, layers = found.get("grid", ("?", "?", "?"))
    graded = f", grading {of_settings(found):g}" if found.get("grading") else ""
    fitted = [f"the targets are met within {few(100 * found['fit']['residual'])} %"] if "fit" in found else []
    return Report(
        name="calibration",
        page="table",
        title=f"{found['method']} calibration",
        subtitle=f"of {nx} × {ny} × {layers} masses{graded}",
        lead=sheet_in_words(sheet, material),
        document=found,
        tables=(
            *calibration.tables(),
            *([fit(found)] if "fit" in found else []),
            *damping.tables(material, damped),
        ),
        notes=(*fitted, *found.get("notes", ()), *([f"in this scene: {expected}"] if expected else [])),
        attachments={"springs.toml": partial(write_text, text=to_toml(found))},
        settings={"method": found["method"], "grid": found.get("grid")},
    )


def document(calibration: Calibration) -> dict[str, Any]:
    """The JSON document of `sheetbench calibrate`; of a fit also what the data tell of each spring.

    fit: residual, the largest relative miss of the targets; half_widths, of the springs' 95 % intervals as
    shares of themselves, of area springs as shares of the diagonal's stiffness (null: not seen by the data).
    """
    from lumped import FittedCalibration

    found = calibration.document()
    if isinstance(calibration, FittedCalibration):
        known = calibration.identifiability
        found["fit"] = {
            "residual": calibration.residual,
            "half_widths": known.half_widths if known else {},
            "singular_values": known.singular_values if known else [],
        }
    return found


def fit(calibration: dict[str, Any]) -> Table:
    """A row per spring that was fitted: its 95 % interval. `calibration` as `document` gives it."""
    rows = tuple(
        (
            name,
            "of the diagonal" if name in ("area", "mid_area") else "of itself",
            width if width < inf else None,
        )
        for name, width in calibration["fit"]["half_widths"].items()
    )
    columns = (Column("spring"), Column("share"), Column("±", "", "%", 100.0, ".2f"))
    return Table("What the data tell of each spring: 95 % intervals", columns, rows, "fit")


def to_toml(calibration: dict[str, Any]) -> str:
    """The [springs] table for pasting into a scene, with the lattice that it is for; all digits."""
    lines = ["[springs]", f"grid = {list(calibration['grid'])}", f'masses = "{calibration["masses"]}"']
    if calibration.get("grading"):
        lines.append(f"grading = {_toml(calibration['grading'])}")
    if edges := calibration.get("graded_edges"):
        lines.append(f"graded_edges = {json.dumps(edges)}")
    for name, value in calibration["springs"].items():
        lines.append(f"{name} = {_toml(value)}")
    lines.append(f"layer_distance = {_toml(calibration['layer_distance'])}")
    return "\n".join(lines) + "\n"


def _toml(value: Any) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{axis} = {_toml(k)}" for axis, k in value.items()) + " }"
    if isinstance(value, list):
        return f"[{', '.join(map(_toml, value))}]"
    return repr(float(value))
