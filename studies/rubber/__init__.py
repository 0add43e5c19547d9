"""Constants of measured rubbers, and how far a linear lattice is good for them."""
