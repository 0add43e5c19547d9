"""`compare` in every pair of its options: scenes, grids, springs, references, more models, outputs.

Twice a month somebody finds two options that never met. Rows cover all pairs; the size and the time are
printed (`pytest -s tests/test_matrix.py`). The other verbs: test_matrix_verbs.py and
test_matrix_small.py.
"""

from itertools import combinations, product

import pytest
from matrix_options import GRIDS, OUTPUTS, SCENES, SPRINGS
from matrix_rows import named, pairwise

REFERENCES = (
    ("--reference", "plate"),
    ("--reference", "shell"),
    ("--reference", "shell", "--law", "biot"),
    ("--reference", "solid", "--law", "neo-hookean"),
)
MORE = (
    (),
    ("--model", "solid:elements=2"),
    ("--model", "plate:elements=2x3", "--model", "shell:elements=2,graded=false"),
    ("--model", "lumped-pair:grid=5"),
    ("--model", "lumped:grid=3,k=550"),
    ("--model", "lumped:grid=3,linear=true"),
)
HOW = ((), ("--symmetry",), ("--uncertainty",), ("--no-uncertainty",))
OWN = SPRINGS[::2]  # `linearise` has the others: test_matrix_verbs.py
DIMENSIONS = (OWN, SCENES, MORE, REFERENCES, OUTPUTS, GRIDS, HOW)
ROWS = pairwise(DIMENSIONS)


def test_rows_have_every_pair():
    wanted = sum(len(a) * len(b) for a, b in combinations(DIMENSIONS, 2))
    pairs = {(i, a, j, b) for row in ROWS for (i, a), (j, b) in combinations(enumerate(row), 2)}
    assert len(pairs) == wanted
    assert len(ROWS) < 1.5 * len(OWN) * len(SCENES)
    assert {row[:2] for row in ROWS} == set(product(OWN, SCENES))


@pytest.mark.parametrize("row", ROWS, ids=named)
def test_compare(row, ends):
    springs, scene, *others = row
    ends("compare", *scene, "--elements", "2", *springs, *(part for one in others for part in one))
