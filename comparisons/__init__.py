"""Comparison of models side by side: tables, pictures, VTK files, the command line."""
