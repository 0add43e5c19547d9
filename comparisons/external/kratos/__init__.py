"""Kratos, run in a process of its own: the problem as arrays, the process, and the model made of both."""
