"""A page on this machine where one drags and lattice and shell answer: `sheetbench live`."""
