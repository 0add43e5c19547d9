"""Parameters of a scene from measured displacements, with intervals."""
