"""Runs of a motion: initial state, steps between samples, samples and their storage, end of a run."""
