"""Models: their specifications, grids, springs and sizes on a scene, and their solve."""
