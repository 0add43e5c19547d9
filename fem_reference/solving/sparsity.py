"""Element matrices into a compressed sparse matrix whose pattern is found once.

Every entry of every element matrix has a slot in the matrix's data; assembling is one product with a matrix
of ones. Held unknowns carry the number −1 and are left out.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_matrix


class Pattern:
    """Of one kind of element or of several.

    unknowns: for every kind (m, k), the number of each element's unknowns in 0 … size − 1, or −1 where held.
    """

    def __init__(self, *unknowns: np.ndarray, size: int):
        self.size = size
        keys, kept = [], []
        for number in unknowns:
            k = number.shape[1]
            rows = np.repeat(number, k, axis=1).ravel().astype(np.int64)
            columns = np.tile(number, (1, k)).ravel().astype(np.int64)
            kept.append(np.nonzero((rows >= 0) & (columns >= 0))[0])
            keys.append(rows[kept[-1]] * size + columns[kept[-1]])
        key, slots = np.unique(np.concatenate(keys), return_inverse=True)
        apart = np.split(slots, np.cumsum([len(one) for one in keys])[:-1])
        self._sums = [
            _sum_of(where, which, (len(key), number.size * number.shape[1]))
            for where, which, number in zip(apart, kept, unknowns, strict=True)
        ]
        self._columns = (key % size).astype(np.int32)
        self._starts = np.searchsorted(key, np.arange(size + 1, dtype=np.int64) * size).astype(np.int32)
        self._diagonal = np.searchsorted(key, np.arange(size, dtype=np.int64) * (size + 1))

    def matrix(self, *blocks: np.ndarray, diagonal: np.ndarray | None = None) -> csr_matrix:
        """Sum of element matrices (m, k, k) by kind, kinds left out being zero, and of a diagonal (size,)."""
        data = np.zeros(len(self._columns))
        for sums, block in zip(self._sums, blocks, strict=False):
            data += sums @ block.ravel()
        if diagonal is not None:
            data[self._diagonal] += diagonal
        assembled = csr_matrix((data, self._columns, self._starts), shape=(self.size, self.size))
        assembled.has_canonical_format = True
        return assembled


def _sum_of(slots: np.ndarray, entries: np.ndarray, shape: tuple[int, int]) -> csr_matrix:
    """The map from the element matrices' entries to their sums by slot."""
    return csr_matrix((np.ones(len(slots)), (slots, entries)), shape=shape)
