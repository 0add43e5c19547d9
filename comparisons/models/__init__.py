"""Models: their specifications, grids, springs and sizes on a scene, symmetry, and their solve."""
