"""Discrete sheets of any repeated cell: moduli, nearest coefficients, the error of fine meshes."""
