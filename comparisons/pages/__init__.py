"""A page of what a folder holds: one HTML file with its sheets, tables, plots and words, for any browser."""
