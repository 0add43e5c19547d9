"""Linear systems: factorisations, constraints, threads."""
