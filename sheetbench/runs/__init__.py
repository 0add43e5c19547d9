"""Runs of a motion, whatever moves: how samples divide one, what a sample holds, where samples are kept."""
