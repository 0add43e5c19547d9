"""Linear algebra and path tracing for both solvers: equations, no mechanics."""
