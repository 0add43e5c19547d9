"""Verification of the references against published values; `CASES` lists the benchmarks."""

from fem_reference.verification.cases import CASES, Verification, verify

__all__ = ["CASES", "Verification", "verify"]
