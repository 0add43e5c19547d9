"""Curves without units that any code of sheets can be laid over."""
