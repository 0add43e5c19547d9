"""The expected error of a lattice's grid on a hundred scenes, beside the true one."""
