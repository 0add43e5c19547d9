"""Springs and dampers, one kind a file: links, areas, strains of cells."""
