"""The geometrically nonlinear solid."""
