"""Which parameters belong to measured displacements, and how sure that is."""
