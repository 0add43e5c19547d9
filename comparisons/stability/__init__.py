"""Ranges of a scene's parameters in which each model is accurate, inaccurate, refuses or fails."""
