"""Deformed sheets to be turned and played: `sheetbench view`, in a browser or in a window."""
