"""Kratos, run in a process of its own: the problem it is given, the process, and the model made of both."""
