"""Runs of a motion of any model: their division into samples, the contents of samples, their storage."""
