"""Who answers: models by name, candidates (a model with its settings), plug-ins, symmetry, grids."""
