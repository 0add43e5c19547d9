"""Other people's programs as models: CalculiX, Kratos, FElupe; none is needed for anything else."""
