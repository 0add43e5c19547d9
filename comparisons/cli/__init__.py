"""The command line, one verb a file."""

from comparisons.cli.app import main

__all__ = ["main"]
