"""What moves: the discrete sheets, as the integrators and the runner of motions have them."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence

import numpy as np

from fem_reference.discrete.sheet import Discrete
from sheetbench.answers.solution import Status
from sheetbench.errors import NoEquilibrium
from sheetbench.numerics.continuation.stability import require_stable
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.motion import NO_START, at_start, starts_flat


class MovingSheet(Discrete):
    """A discrete sheet that knows where its motion starts."""

    @abstractmethod
    def equilibrium(self, scene: Scene) -> tuple[np.ndarray, Status, Sequence[str]]:
        """q (N,) under the full load of a scene, of this one's sheet; how the path there ended, and notes."""

    def start(self) -> np.ndarray:
        """q (N,) at t = 0: flat, or the equilibrium to start from (`scenes.meaning.motion`). Raises
        NoEquilibrium where there is no stable one."""
        if starts_flat(self.scene):
            return self.placed(np.zeros(self.size), 0.0)
        q, status, notes = self.equilibrium(at_start(self.scene))
        try:
            require_stable(self.model, status, notes)
        except NoEquilibrium as error:
            raise NoEquilibrium(f"{NO_START}: {error}") from None
        return self.placed(q, 0.0)
