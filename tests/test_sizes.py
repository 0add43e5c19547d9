"""`make sizes` counts what a reader would call code."""

from sizes import lines_of_code

SOURCE = '''"""A module.

Of two paragraphs.
"""

import os
from a import (
    b,
)

NAMES = [
    "one",  # a comment counts with its line
]


# a line of its own
def f():
    """Return nothing."""
    text = """two
lines"""
    import c
    return text
'''


def test_blanks_comments_docstrings_and_imports_are_no_code():
    assert lines_of_code(SOURCE) == 3 + 1 + 2 + 1
