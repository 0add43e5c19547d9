"""How equilibrium is found: Newton's method, linear solvers, sparsity, threads."""
