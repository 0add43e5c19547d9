"""Parts shared by the models of a surface: meshes, loads, supports, rods along edges, points on it."""
