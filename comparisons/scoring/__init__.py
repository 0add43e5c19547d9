"""Answers in: somebody's values for the reference set, scored beside other models, their faults named."""
