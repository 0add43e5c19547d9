"""Bricks of a sheet that is not flat at rest: sampled strains less X,α · E0(z) X,β of the natural stretch
U(z) = 1 + e0 − z k0, which leaves the thickness alone; z is measured from the plane that e0 is of."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from fem_reference.solid.element import SAMPLED, Bricks, reference, shape
from fem_reference.solid.materials import PAIRS
from fem_reference.surface.natural import NaturalStrains, green
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.composition import of_sheet
from sheetbench.scenes.meaning.natural_state import natural_at


@dataclass(frozen=True)
class NaturalBricks(Bricks):
    """natural: their strains; area: det U at the Gauss points (m, q), by which volumes have grown."""

    natural: NaturalStrains = field()  # no longer None by default
    area: np.ndarray

    @classmethod
    def of(cls, plain: Bricks, scene: Scene) -> Bricks:
        """Return the bricks of a scene, plain ones of a sheet that is flat at rest."""
        if not scene.natural_by:
            return plain
        tables = [shape((np.array(sites).T + 1.0) / 2.0) for sites in SAMPLED]
        sites = np.concatenate([value.T for value, _ in tables]) @ plain.positions  # (m, k, 3)
        state = natural_at(scene, sites[..., :2])
        if state is None:
            return plain
        first, second = (
            np.concatenate([slope[:, pair[side]].T for (_, slope), pair in zip(tables, PAIRS, strict=True)])
            @ plain.positions[..., :2]
            for side in (0, 1)
        )
        counts = [value.shape[1] for value, _ in tables]
        twice = np.repeat([1.0 if a == b else 2.0 for a, b in PAIRS], counts)
        height = (sites[..., 2] - middle(scene))[..., None, None]

        def sample(strain: np.ndarray, curvature: np.ndarray) -> np.ndarray:
            free = green(strain - height * curvature)
            return twice * np.einsum("eki,ekij,ekj->ek", first, free, second)

        on, area = _of_natural_sides(plain, scene)
        natural, volumes = NaturalStrains(state, sample), area * plain.volumes
        return cls(plain.positions, plain.law, plain.material, on, volumes, natural, area)

    def strain(self, change: np.ndarray) -> np.ndarray:
        """Sampled strains less the natural ones."""
        return super().strain(change) - self.natural.now

    def products(self) -> np.ndarray:
        """The mass is that of the sheet as drawn."""
        return replace(self, volumes=self.volumes / self.area)._products()


def middle(scene: Scene) -> float:
    """Height [m] over the middle of the plane that natural strains and curvatures are of."""
    plies = of_sheet(scene).plies
    return -(plies[0].low + 0.5) * scene.sheet.thickness if plies else 0.0


def _of_natural_sides(plain: Bricks, scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Cartesian strains U⁻¹ E U⁻¹ of the samples (m, q, 6, k), and det U (m, q)."""
    points = shape(reference().points)[0].T @ plain.positions[..., :2]
    state = natural_at(scene, points)
    assert state is not None
    stretch = np.zeros((*points.shape[:2], 3, 3))
    stretch[..., :2, :2] = state.at(state.factors())[0]
    stretch += np.eye(3)
    inverse = np.linalg.inv(stretch)
    columns = []
    for a, b in PAIRS:
        unit = np.zeros((3, 3))
        unit[a, b] = unit[b, a] = 1.0 if a == b else 0.5
        turned = inverse @ unit @ inverse
        columns.append([turned[..., i, j] * (1.0 if i == j else 2.0) for i, j in PAIRS])
    turn = np.moveaxis(np.array(columns), (0, 1), (-1, -2))
    return turn @ plain.to_strain, np.linalg.det(stretch)
