"""Named tuples that carry their numba type: the same to compiled functions as without it."""

from typing import NamedTuple

import numpy as np
from numba import njit, typeof

from sheetbench.numerics.typed import TypedTuple, typed


class Inner(NamedTuple):
    values: np.ndarray
    number: int


class Other(NamedTuple):
    values: np.ndarray
    number: int


class Outer(NamedTuple):
    inner: Inner | Other
    at: np.ndarray


def test_a_compiled_function_takes_a_typed_tuple_as_the_named_one():
    """Tuples of two classes with the same arrays, typed before or not, are told apart."""

    @njit
    def total(outer):
        return outer.inner.values[outer.at[0]] + outer.inner.number

    values, at = np.array([1.0, 2.0]), np.array([1])
    for kind in (Inner, Other):
        plain = Outer(kind(values, 3), at)
        within = Outer(typed(kind(values, 3)), at)
        for given in (plain, typed(plain), within, typed(within)):
            assert total(given) == 5.0
            assert typeof(given) == typeof(plain)
        assert isinstance(typed(plain), TypedTuple)
    assert len(total.signatures) == 2
