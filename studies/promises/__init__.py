"""Promised errors beside the errors that there are: bars, expected errors, advice."""
