"""How the sheet moves: histories of the probes, measured ones beside them, and animations."""
