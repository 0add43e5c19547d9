"""Answers in: somebody's values for the reference set, scored, their faults named, beside our own models."""
