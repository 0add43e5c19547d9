"""The references in motion: M ü + C u̇ + f(u) = F(t), one integrator for all of them."""
