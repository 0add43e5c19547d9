"""Simulators of others, made to answer the same questions as ours (see `comparisons.plugins`)."""
