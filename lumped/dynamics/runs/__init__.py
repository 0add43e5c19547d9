"""Runs of a motion: the start, steps from sample to sample, what is sampled and kept, what ends one."""
