"""Linear algebra that both solvers use: equations, no mechanics."""
