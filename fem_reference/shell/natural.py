"""Shell elements of a sheet that is not flat at rest: sampled strains less the natural ones,

    n = X,α · E0 X,β,    X,α · κ0 X,β

at the sites where `element` samples membrane and bending strains; shear has none."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from fem_reference.shell.element import GRIDS, STRAINS, DraggedElement, Element
from fem_reference.surface.biquadratic import product_grid, shape
from fem_reference.surface.materials import Section
from fem_reference.surface.natural import NaturalStrains, grown, of_shell
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.natural_state import natural_at


@dataclass(frozen=True)
class NaturalElement(Element):
    """natural: their strains."""

    natural: NaturalStrains = field()  # no longer None by default

    @classmethod
    def of(cls, nodes: np.ndarray, section: Section, scene: Scene) -> Element:
        """Return the elements of a scene with nodes (m, 9, 2) [m], plain ones of a sheet that is flat at
        rest."""
        if not scene.natural_by:
            return Element.build(nodes, section)
        plain = Element.build(nodes, grown(section, scene, nodes))
        tables = [(component, *shape(*product_grid(*GRIDS[name]))) for name, component in COMPONENTS.items()]
        sites = np.concatenate([value for _, value, _ in tables]) @ nodes
        state = natural_at(scene, sites)
        if state is None:
            return plain
        along, across = (
            np.concatenate([slope[component[side]] for component, _, slope in tables]) @ nodes
            for side in (0, 1)
        )

        def sample(strain: np.ndarray, curvature: np.ndarray) -> np.ndarray:
            parts = [
                np.einsum("eki,ekij,ekj->ek", along, form, across) for form in of_shell(strain, curvature)
            ]
            none = np.zeros((len(nodes), STRAINS - 2 * along.shape[1]))
            return np.concatenate([*parts, none], axis=1)

        return cls(plain.reference, plain.stiffness, plain.areas, NaturalStrains(state, sample))

    def strain(self, change: np.ndarray) -> np.ndarray:
        """Sampled strains less the natural ones."""
        return super().strain(change) - self.natural.now

    def dragged(self, strain: np.ndarray, drag: float) -> Element:
        """Elements whose past is less far from the natural strains."""
        past = strain * (drag / (1.0 + drag)) + self.natural.now
        return DraggedElement(self.reference, (1.0 + drag) * self.stiffness, self.areas, past)


COMPONENTS = {"rr": (0, 0), "ss": (1, 1), "rs": (0, 1)}
