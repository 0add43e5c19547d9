"""Ours and other people's codes on the same sheet, in one run: error against time, at rest and in motion."""
