"""Verification of the references against published values: one benchmark a file, `CASES` lists them."""

from fem_reference.verification.cases import CASES, run
from fem_reference.verification.rows import Case, Row

__all__ = ["CASES", "Case", "Row", "run"]
