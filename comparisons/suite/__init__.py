"""The reference set: scenes with converged values and error bars, for models to be scored against."""
