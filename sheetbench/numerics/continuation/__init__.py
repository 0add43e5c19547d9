"""Paths of equilibria of any structure: load steps, Newton's method, snaps, stability."""
