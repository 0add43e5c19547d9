"""Element matrices into a compressed sparse matrix whose pattern is found once.

Every entry of every element matrix has a slot in the matrix's data; assembling is one weighted count.
Held unknowns carry the number −1 and are left out.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_matrix


class Pattern:
    """unknowns: (m, k), the number of each element's unknowns in 0 … size − 1, or −1 where held."""

    def __init__(self, unknowns: np.ndarray, size: int):
        self.size = size
        self.unknowns = unknowns
        k = unknowns.shape[1]
        rows = np.repeat(unknowns, k, axis=1).ravel().astype(np.int64)
        columns = np.tile(unknowns, (1, k)).ravel().astype(np.int64)
        self._kept = np.nonzero((rows >= 0) & (columns >= 0))[0]
        key, self._slots = np.unique(rows[self._kept] * size + columns[self._kept], return_inverse=True)
        self._columns = (key % size).astype(np.int32)
        self._starts = np.searchsorted(key, np.arange(size + 1, dtype=np.int64) * size).astype(np.int32)
        self._entries = len(key)
        self._diagonal = np.searchsorted(key, np.arange(size, dtype=np.int64) * (size + 1))
        self._free = np.nonzero(unknowns.ravel() >= 0)[0]

    def matrix(self, element_matrices: np.ndarray, diagonal: np.ndarray) -> csr_matrix:
        """Sum of element matrices (m, k, k), plus a diagonal (size,), as a sparse matrix (size, size)."""
        data = np.bincount(self._slots, element_matrices.ravel()[self._kept], self._entries)
        data[self._diagonal] += diagonal
        assembled = csr_matrix((data, self._columns, self._starts), shape=(self.size, self.size))
        assembled.has_canonical_format = True
        return assembled

    def vector(self, element_vectors: np.ndarray) -> np.ndarray:
        """Sum of element vectors (m, k) as a vector (size,)."""
        return np.bincount(self.unknowns.ravel()[self._free], element_vectors.ravel()[self._free], self.size)


class Union:
    """An assembled matrix and further element matrices in one, of a pattern found at the first sum."""

    def __init__(self, size: int):
        self.size = size
        self._slots: np.ndarray | None = None
        self._columns = self._starts = np.zeros(0, dtype=np.int32)

    def matrix(self, first: csr_matrix, entries: list[tuple[np.ndarray, np.ndarray]]) -> csr_matrix:
        """The sum (size, size) of a matrix of the first unknowns and of element matrices (m, k, k), each with
        its unknowns (m, k), −1 where held."""
        kept = [(number[:, :, None] >= 0) & (number[:, None, :] >= 0) for number, _ in entries]
        if self._slots is None:
            lines = np.repeat(np.arange(first.shape[0]), np.diff(first.indptr)).astype(np.int64)
            keys = [lines * self.size + first.indices]
            for (number, _), free in zip(entries, kept, strict=True):
                keys.append((number[:, :, None].astype(np.int64) * self.size + number[:, None, :])[free])
            key, self._slots = np.unique(np.concatenate(keys), return_inverse=True)
            self._columns = (key % self.size).astype(np.int32)
            starts = np.arange(self.size + 1, dtype=np.int64) * self.size
            self._starts = np.searchsorted(key, starts).astype(np.int32)
        parts = [first.data, *(matrix[free] for (_, matrix), free in zip(entries, kept, strict=True))]
        data = np.bincount(self._slots, np.concatenate(parts), len(self._columns))
        joined = csr_matrix((data, self._columns, self._starts), shape=(self.size, self.size))
        joined.has_canonical_format = True
        return joined
