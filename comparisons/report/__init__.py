"""How it is shown: tables, files, VTK, the dress of plots and the off-screen stage."""
