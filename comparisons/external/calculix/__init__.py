"""CalculiX, run as the program `ccx`: the deck it is given, the results it leaves, the model of both."""
