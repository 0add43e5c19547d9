"""A scene: the question to a model, in raw physics (E, ν, ρ, geometry, supports, loads, probes; SI).

A scene depends on no solver. It is read from TOML (`sheetbench.scenes.files`) or built as `Scene(…)`,
validated once, and frozen. Its keys are in `scenes.objects.fields`, their meaning in `scenes.meaning`.
"""

from collections.abc import Iterator
from difflib import get_close_matches
from pathlib import Path
from typing import Any, Self

from sheetbench.errors import WrongArgument
from sheetbench.scenes.language import summary
from sheetbench.scenes.meaning import corners, distances, region
from sheetbench.scenes.meaning.words import in_words
from sheetbench.scenes.objects.cutouts import nearest
from sheetbench.scenes.objects.fields import LISTS, SceneFields
from sheetbench.scenes.objects.layers import misfit
from sheetbench.scenes.objects.patches import mismatched, misplaced
from sheetbench.scenes.objects.quantities import PlanPoint
from sheetbench.scenes.objects.sheet import EDGES
from sheetbench.scenes.objects.supports import held_axes, place


class Scene(SceneFields, defer_build=False):
    """A sheet with supports, loads, actuators and probes.

    Lists are tuples; in TOML they are [[support]], [[load]], [[actuator]].
    """

    def _faults(self) -> Iterator[object]:
        vars(self)["supports"] = region.with_rims(self)  # the scene is frozen, but not whole yet
        if not self.probes:
            vars(self)["probes"] = self._default_probes()
        lx, ly = self.sheet.lengths
        for key, (x, y) in region.marked(self).items():
            off = f"{key} = {[x, y]} is off the sheet, which is 0 ≤ x ≤ {lx:g} m, 0 ≤ y ≤ {ly:g} m"
            yield not (0.0 <= x <= lx and 0.0 <= y <= ly) and off
        yield self.patches and misplaced(self.patches, self.sheet)
        if self.shaped_by:
            yield from region.misplaced(self)
        if self.layers:
            varied = f"layer: a laminate is the same all over, without {self.varied_by}"
            yield not self.homogeneous and varied
            yield misfit(self.layers, self.sheet, self.material)
        yield self._natural_fault()
        yield mismatched(self.patches, self.material)
        law = f"springs: of a material with law = '{self.material.law}' they are calibrated; leave one out"
        yield self.springs and self.material.law and law
        number = next((n for n, load in enumerate(self.loads, start=1) if load.hold), 0)
        idle = 'has no effect without [initial] shape = "static", which lets the load go at t = 0'
        yield number and not self.initial and f"load {number}.hold = true: {idle}"
        yield from distances.conflicts(self)
        yield from corners.conflicts(self.actuators, self.supports, self.sheet)

    def _default_probes(self) -> dict[str, PlanPoint]:
        """Return centre P1, middles P2 (y side) and P3 (x side) beside P4, the corner farthest from supports.

        A point on a held edge would not move: it is placed a quarter of the sheet inside.
        """
        sheet, (lx, ly) = self.sheet, self.sheet.lengths
        supports = [support for support in self.supports if place(support) is None]
        held = [support.edge for support in supports if 2 in held_axes(support)]
        held += [motion.edge for motion in self.motions().values()]

        def distance(corner: PlanPoint) -> float:
            return sum(abs(corner[EDGES[s.edge].normal_axis] - sheet.edge_at(s.edge)) for s in supports)

        far = max([(lx, ly), (lx, 0.0), (0.0, ly), (0.0, 0.0)], key=distance)  # of ties the first
        points = {"P1": (lx / 2, ly / 2), "P2": (lx / 2, far[1]), "P3": (far[0], ly / 2), "P4": far}
        ends = [(EDGES[edge].normal_axis, sheet.edge_at(edge)) for edge in held]
        moved = {(axis, at): 0.25 * sheet.lengths[axis] + 0.5 * at for axis, at in ends}
        probes = {k: (moved.get((0, x), x), moved.get((1, y), y)) for k, (x, y) in points.items()}
        return {k: nearest(self.region, at) for k, at in probes.items()} if self.pierced else probes

    def _natural_fault(self) -> str:
        """Return the reason why a natural strain or a temperature is impossible, "" if it is possible."""
        if not (given := ", ".join(self.natural_states)):
            return ""
        if self.material.law is not None:
            return f"{given}: not of rubber (law = '{self.material.law}'), whose strains it would multiply"
        if self.material.branches.times and any(one.history for one in self.natural_states.values()):
            return f"{given}: with a history it takes no Maxwell branches; leave one out"
        if self.natural is not None and self.natural.pretension is not None and not self.homogeneous:
            return f"natural.pretension: not with {self.varied_by}; give strain"
        if self.temperature is not None:
            bare = [n for n, layer in enumerate(self.layers, start=1) if layer.expansion is None]
            unlike = self.material.expansions or (0.0, 0.0)
            if self.material.expansion is None and (bare or not self.layers):
                return "temperature: needs expansion [1/K], of the material or of every layer"
            if unlike[0] != unlike[1] and any(patch.angle is not None for patch in self.patches):
                return "temperature: with patch.angle, expansion must be one number"
        return ""

    def replace(self, **values: Any) -> Self:
        """Return a copy with other values for some keys of the scene, of its sheet or of its material.

        Default probes follow a new outline. Raises SceneError for values that are impossible.
        """
        parts = (self, self.sheet, self.material)
        keys = [*LISTS.values(), *(key for part in parts for key in type(part).model_fields)]
        for key in values:
            if key not in keys and (near := get_close_matches(key, keys, 1)):
                raise WrongArgument(f"replace: {key}: unknown key; did you mean {near[0]}?")
        for part in ("sheet", "material"):
            kind = type(getattr(self, part))
            own = {key: values.pop(key) for key in list(values) if key in kind.model_fields}
            if own:
                values[part] = kind.model_validate(values.get(part, getattr(self, part))).replace(**own)
        drawn = {key: values[key] for key in ("sheet", "cutouts") if key in values}
        redrawn = any(value != getattr(self, key) for key, value in drawn.items())
        if redrawn and "probes" not in values and self.probes == super().replace(probes={}).probes:
            values["probes"] = {}
        return super().replace(**values)

    def __repr__(self) -> str:
        return summary.text(f"Scene {self.name}", in_words(self))

    def save(self, path: str | Path) -> None:
        """Write the scene as TOML, from which `load` reads an equal scene."""
        from sheetbench.scenes.language.toml import to_toml  # a scene that is only solved does not need it

        Path(path).write_text(to_toml(self), encoding="utf-8")
