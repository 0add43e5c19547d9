"""Errors of calibrations on scenes that they were not made for."""
