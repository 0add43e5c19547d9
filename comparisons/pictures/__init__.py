"""Pictures of sheets, VTK files, progress, and amounts in words."""
