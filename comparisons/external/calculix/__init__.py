"""CalculiX, run as the program `ccx`: its input deck, its results, and the model made of both."""
