"""Dimensionless curves for the comparison of any codes of sheets."""
