"""The reference set of converged cases, and answers scored against it."""
