"""Lattice and reference side by side: how far apart, and which differences the error bar tells apart."""
