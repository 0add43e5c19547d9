"""Models and external codes side by side, each with its own mesh convergence: which of them differ?"""
