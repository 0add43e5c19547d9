"""Fields over the cells of a sheet, E, ν, h, ρ and natural state: lattices of any values, and derivatives.

Springs of a cell follow from its own section by the closed form of `lumped.calibration.closed_form`, at the
lattice's own layer distance, so that some springs may be slightly negative here. Along edges and rims a cell
keeps the factor f of its twisting stiffness from the lattice's own calibration: a strip of equal cells has
one f at any E (`lumped.calibration.edge_twist`). Each cell's constants depend on that cell alone, and are in
proportion to its E: by ν and h one difference with all cells changed at once gives all rates, which are found
once a lattice.

Fields over the cells (rows, columns), from y0 to y1, each row from x0 to x1:

    cells.young, cells.poisson, cells.thickness, cells.density      [Pa], [-], [m], [kg/m³]
    cells.strain, cells.curvature     (…, 3), natural, xx, yy and xy; [1/m]

young scales all moduli of fibres. A cell that several parts share has the E, ν, h and ρ of an isotropic sheet
with its stiffness and mass.
"""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from dataclasses import replace
from functools import cached_property

import numpy as np

from lumped.assembly import Assembly
from lumped.calibration import Calibration
from lumped.calibration.cell_by_cell import GridCells, each_cell
from lumped.calibration.closed_form import springs_of_cells
from lumped.calibration.consistent import closed_form_options
from lumped.masses import shares_of_layers
from lumped.natural import grown
from lumped.natural import powers as natural_powers
from lumped.parameter_sides import same_method
from lumped.pretension import size_at_rest
from lumped.sections import CellSection, of_cells, ratio, twisting
from lumped.spring_constants import EDGES_OWN, NONE, RIMS_OWN, Springs
from lumped.springs.all_families import cell_springs, faces_by_cells, families_of, stiffness_by_cells
from lumped.springs.families import Family
from lumped.springs.law_table import FACE
from sheetbench.errors import BadInput
from sheetbench.scenes import Cells, Scene
from sheetbench.scenes.meaning.natural_state import NaturalState

FIELD = "cells."
YOUNG, POISSON, THICKNESS, DENSITY = NUMBERS = tuple(
    FIELD + name for name in ("young", "poisson", "thickness", "density")
)
STRAIN, CURVATURE = STATE = FIELD + "strain", FIELD + "curvature"
OF_SECTION = {YOUNG, POISSON, THICKNESS}
SECTION_AND_STRAIN = {*OF_SECTION, STRAIN}  # which the rates of springs depend on
ROUNDING = 1e-9  # of the largest constant
NOTHING = 1e-300  # N/m, a stiffness of springs that are there
STEP = 1e-5  # of a field, for differences of springs, whose error is of its square
Values = Mapping[str, np.ndarray]
SYMMETRIC = [[0, 2], [2, 1]]  # the tensor of components xx, yy and xy
# of each kind of springs: the cells beside each, (q, m), and their shares (q, m, n) of its constants
Shares = list[tuple[np.ndarray, np.ndarray]]
Rates = dict[str, tuple[Shares, np.ndarray]]  # of springs by fields, each once


class CellFields:
    """The fields of a scene's lattice `assembly` with the springs of a calibration."""

    def __init__(self, scene: Scene, calibration: Calibration, assembly: Assembly):
        self.scene, self.calibration, self.assembly = scene, calibration, assembly
        self.shape, self._kept = assembly.lattice.cell_areas.shape, Rates()
        self.isotropic = scene.material.kind != "orthotropic" and not scene.layers

    @cached_property
    def section(self) -> CellSection:
        """The sections of all cells."""
        if (cells := self.calibration.cells) is not None:
            return cells
        return of_cells(Cells.of(self.scene.sheet, self.scene.material), self.calibration.grid)

    @cached_property
    def base(self) -> dict[str, np.ndarray]:
        """Fields of the unchanged scene by name."""
        section, share = self.section, 1.0 if self.section.share is None else self.section.share
        form, bent = section.membrane, section.bending[..., 0, 0]
        thickness = np.sqrt(ratio(12.0 * bent, form[..., 0, 0]))
        free = form[..., 0, 0] - ratio(form[..., 0, 1] ** 2, form[..., 1, 1])
        young, density = (ratio(of, thickness * share) for of in (free, section.per_area))
        numbers = young, ratio(form[..., 0, 1], form[..., 1, 1]), thickness, density
        state = np.zeros((2, *self.shape, 2, 2))
        if self.assembly.natural is not None:
            state = self.assembly.natural.made(lambda *forms: forms).at()
        components = (form[..., [0, 1, 0], [0, 1, 1]] for form in state)
        return dict(zip((*NUMBERS, *STATE), (*numbers, *components), strict=True))

    def value(self, name: str, values: Values) -> np.ndarray:
        """Return a field from the given values, by default the scene's. Raises BadInput for another name."""
        if name not in self.base:
            raise BadInput(f"{name}: choose from {', '.join(self.base)}")
        return np.asarray(values.get(name, self.base[name]))

    def changed_section(self, values: Values) -> CellSection:
        """Return the sections of cells with other fields."""
        section, base = self.section, self.base
        if not values.keys() & {*NUMBERS}:
            return section

        changes = (ratio(values.get(one, base[one]), base[one]) for one in (YOUNG, THICKNESS, DENSITY))
        e, t, rho = (change[..., None, None] for change in changes)
        membrane, bending, shear = section.membrane * e * t, section.bending * e * t**3, section.shear * e * t
        if POISSON in values:
            if not self.isotropic:
                raise BadInput("cells.poisson: of isotropic sheets only")
            was, now = base[POISSON], values[POISSON]
            for form in (membrane, bending):
                form *= ((1.0 - was**2) / (1.0 - now**2))[..., None, None]
                form[..., [0, 1], [1, 0]] += ((now - was) * form[..., 1, 1])[..., None]
                form[..., 2, 2] *= (1.0 - now) / (1.0 - was)
            shear *= ((1.0 + was) / (1.0 + now))[..., None, None]
        mixed, per_area = section.mixed * e * t**2, section.per_area * (t * rho)[..., 0, 0]
        parts = {"membrane": membrane, "bending": bending, "shear": shear, "mixed": mixed}
        return replace(section, **parts, per_area=per_area)

    def springs(self, *each: Values) -> list[Springs]:
        """Return the springs of cells with other values of equal fields. Raises BadInput for ν and h if the
        lattice's own are not in closed form."""
        sections = [self.changed_section(values) for values in each]
        constants, young = self.calibration.constants, self.base[YOUNG]
        if each[0].keys() & {POISSON, THICKNESS}:
            each_grid = [replace(self._at_rest, section=cells) for cells in (self.section, *sections)]
            distance, options = constants.layer_distance, closed_form_options(self.calibration.method)
            found = springs_of_cells(GridCells.stacked(each_grid), distance, True, **options)
            own, *inside = found.split(len(each_grid))
            largest = max(np.abs(np.asarray(part)).max() for part in own.of.values())
            for name in constants.of.keys() - {*EDGES_OWN, *RIMS_OWN}:
                if np.abs(constants[name] - own[name]).max(initial=0.0) > ROUNDING * largest:
                    which = f"springs of '{self.calibration.method}', not in closed form"
                    raise BadInput(f"cells.poisson, cells.thickness: {which}")
        else:
            inside = [constants.scaled(ratio(values.get(YOUNG, young), young)) for values in each]
        return [self._with_edges(cells, springs) for cells, springs in zip(sections, inside, strict=True)]

    def _with_edges(self, cells: CellSection, springs: Springs) -> Springs:
        """Return the cells' springs with the springs of edges and rims, whose twist factors stay."""
        constants, of = self.calibration.constants, dict(springs.of)
        now, was = (twisting(section.bending) for section in (cells, self.section))
        factor = np.divide(now, was, out=np.ones_like(now), where=was > 0.0)
        for name in constants.of.keys() & {*RIMS_OWN}:
            of[name] = (constants.along(name, 0) * factor[..., 0],)
        for name in EDGES_OWN if constants.of.keys() & {*EDGES_OWN} else ():
            near, end = name.removeprefix("far_"), -1 if name.startswith("far_") else 0
            pair = constants.of.get(name, constants.of.get(near, NONE))
            by = (1.0, 1.0) if near == "edge_coupling" else (factor[:, [end], 0], factor[[end], :, 1])
            of[name] = pair[0] * by[0], pair[-1] * by[1]
        return Springs(of, constants.layer_distance)

    @cached_property
    def _at_rest(self) -> GridCells:
        scene, of = self.scene, self.calibration
        sheet = size_at_rest(scene, lambda first: same_method(of, scene)(first))
        return each_cell(sheet, scene.material, of.grid, of.grading, self.section)

    def assembly_of(self, values: Values, complete: bool = False) -> Assembly:
        """Return the lattice of cells with other fields; complete: with springs of the mid-surface even where
        they have no stiffness, which other values may need."""
        assembly, springs = copy(self.assembly), self.calibration.constants
        if values.keys() & OF_SECTION:
            springs = self.springs(values)[0]
        if complete:
            springs = replace(springs, of=springs.of | {"mid_area": (np.full(self.shape, NOTHING),)})
        natural, assembly.natural = assembly.natural, None
        assembly._take(families_of(assembly.lattice, assembly.pattern, springs))
        if values.keys() & {*STATE}:
            natural = NaturalState.given(np.concatenate([self.value(one, values) for one in STATE], axis=-1))
        if natural is not None:
            assembly.grow(natural.made(lambda *forms: forms))
        if values.keys() & {DENSITY, THICKNESS}:
            assembly.cells = self.changed_section(values)
        return assembly

    def by_number(
        self, name: str, values: Values, assembly: Assembly, by: list[np.ndarray], v: np.ndarray, kept: Rates
    ) -> np.ndarray:
        """Return the derivatives of v·(f − f_int) by a field of numbers, of the complete lattice `assembly`;
        by: of v·f_int by all constants of the springs (`AllFamilies.powers_by_constants`); kept: known rates
        of springs at the values; new rates are added to it."""
        found = np.zeros_like(self.value(name, values))
        of_springs, over = self._rates(name, values, assembly, kept) if name in OF_SECTION else ([], found)
        for (cells, change), power in zip(of_springs, by, strict=False):
            each = np.einsum("qmn,mn->qm", change, power[:, : change.shape[2]])
            found -= np.bincount(cells.ravel(), each.ravel(), found.size).reshape(found.shape) / over
        if name in (DENSITY, THICKNESS) and self.scene.gravity is not None:
            acceleration = self.scene.gravity.last_factor * np.array(self.scene.gravity.acceleration)
            per_area = ratio(self.changed_section(values).per_area, self.value(name, values))
            found += per_area * self._of_masses(v[: assembly.lattice.mass_count] @ acceleration)
        return found

    def by_state(self, values: Values, assembly: Assembly, by: list[np.ndarray]) -> dict[str, np.ndarray]:
        """Return the derivatives of v·(f − f_int) by the fields of STATE, as `by_number` does."""
        state = [self.value(one, values)[..., SYMMETRIC] for one in STATE]
        lattice, flat = assembly.lattice, assembly.springs
        if assembly.natural is not None:
            flat = families_of(lattice, assembly.pattern, self.springs(values)[0]).families
        found = natural_powers(lattice, flat[:3], state, by[:3])
        return dict(zip(STATE, np.split(-found, 2, axis=-1), strict=True))

    def rates_at(self, values: Values) -> Rates:
        """Return the rates of springs by fields that are known at other values."""
        return self._kept if values.keys().isdisjoint(SECTION_AND_STRAIN) else {}

    def _rates(self, name: str, values: Values, assembly: Assembly, kept: Rates) -> tuple[Shares, np.ndarray]:
        """Return the changes of the springs (`by_cells`) by a change of a field, and that change; for ν and h
        in one pass."""
        values = {one: values[one] for one in values.keys() & SECTION_AND_STRAIN}
        if name == YOUNG and name not in kept:  # which all constants are in proportion to, but for a limit
            of = {one: parts for one, parts in self.springs(values)[0].of.items() if one != "gent_limit"}
            kept[name] = self.by_cells(Springs(of), assembly, values), self.value(name, values)
        if name not in kept:
            names = (POISSON, THICKNESS) if self.isotropic else (name,)
            base = {one: self.value(one, values) for one in names}
            steps = {one: STEP * np.maximum(np.abs(of), 0.1 * (one == POISSON)) for one, of in base.items()}
            ends = ({**values, one: base[one] + by * steps[one]} for one in names for by in (1.0, -1.0))
            found = iter([self.by_cells(springs, assembly, values) for springs in self.springs(*ends)])
            for one, step in steps.items():
                pairs = zip(next(found), next(found), strict=True)
                kept[one] = [(cells, high - low) for (cells, high), (_, low) in pairs], 2.0 * step
        changes, over = kept[name]
        return changes, np.where(over > 0.0, over, 1.0)

    def by_cells(self, springs: Springs, assembly: Assembly, values: Values) -> Shares:
        """Return, for each kind of springs, the cells adjacent to each spring, (q, m), and their
        contributions (q, m, n) to its constants."""
        lattice, none = assembly.lattice, (np.empty((1, 0), int), np.empty((1, 0, 1)))
        these = lattice.links_of(assembly.links.nodes)
        found = [(lattice.links.cells[:, these], stiffness_by_cells(lattice, springs)[:, these])]
        kept = np.arange(lattice.cell_areas.size)[lattice.present_cells]
        plain: list[Family] = [*cell_springs(lattice, assembly.pattern, springs)]
        if (strain := self.value(STRAIN, values)).any():
            plain = grown(lattice, plain, strain[..., SYMMETRIC])
        for family, now in zip(assembly.springs[1:3], plain, strict=True):
            cells = np.tile(kept, len(family) // len(kept))[None]
            found.append((cells, now.constants[None]) if len(family) and len(now) else none)  # type: ignore[attr-defined]
        if not len(assembly.springs[3]):
            return [*found, none]
        stored = faces_by_cells(lattice, springs)
        constants = np.zeros((*stored.shape, FACE.count))
        constants[..., -1] = stored / lattice.faces.at_rest.area**2
        return [*found, (lattice.faces.cells, constants)]

    def _of_masses(self, weight: np.ndarray) -> np.ndarray:
        """Return the derivative of weight · masses by the mass per area of every cell; weight: (n,)."""
        lattice = self.assembly.lattice
        layers = lattice.grid[2]
        shares = shares_of_layers(self.scene, lattice) if self.scene.layers else np.full(layers, 1.0 / layers)
        found = np.zeros(lattice.cell_areas.size)
        found[lattice.present_cells] = 0.25 * (weight[lattice.mid_cells] @ shares).sum(axis=1)
        return found.reshape(self.shape) * lattice.cell_areas
