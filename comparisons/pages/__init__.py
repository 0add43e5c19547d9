"""One HTML page of the studies in a folder: sheets to turn, tables, figures and notes."""
