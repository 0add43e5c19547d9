"""Models and other people's judges side by side, each with its own mesh convergence: who is told apart?"""
