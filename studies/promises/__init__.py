"""Promised errors beside actual errors: bars, expected errors, advice."""
