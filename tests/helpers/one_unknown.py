"""Structures of one unknown u with force f(u) = λ, whatever a test wants f to be."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix

from sheetbench.numerics.continuation.structure import Structure


@dataclass
class Balance:
    residual: float
    size: float = 1.0


@dataclass
class Spring(Structure[float, Balance]):
    force: Callable[[float], float]
    slope: Callable[[float], float]
    symmetric: bool = True

    def rest(self):
        return 0.0

    def forces(self, u, load_factor):
        return Balance(self.force(u) - load_factor)

    def imbalance(self, u, forces):
        return abs(forces.residual)

    def gap(self, u, load_factor):
        return 0.0

    def system(self, u, forces, load_factor, mixed=True):
        return csr_matrix(([self.slope(u)], ([0], [0]))), np.array([-forces.residual])

    def advance(self, u, forces, load_factor, step):
        return u + step[0]

    def length(self, start, end):
        return abs(end - start)
