"""A page on this machine with sliders, for which lattice and shell are solved: `sheetbench live`."""
