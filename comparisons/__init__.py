"""Everything that puts models side by side: comparisons, tables, pictures, VTK files, the command line."""
