"""Readers of measurements: CSV, point clouds, motion capture."""
