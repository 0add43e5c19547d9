"""Deformed sheets in a browser: the viewer, and sheets as it takes them."""
