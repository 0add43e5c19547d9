"""The objects of a scene, one file a table: fields, bounds, and what follows from one object alone."""
