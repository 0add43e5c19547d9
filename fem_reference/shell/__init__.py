"""The geometrically nonlinear Reissner–Mindlin shell."""
