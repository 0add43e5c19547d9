"""Parts that the models of a surface share: meshes, loads, supports, rods along edges, points on the
sheet."""
