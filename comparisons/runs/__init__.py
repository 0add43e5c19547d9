"""Campaigns of runs, their store and workers, and the manifest of a folder."""
