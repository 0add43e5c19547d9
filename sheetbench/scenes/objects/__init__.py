"""The objects of a scene, one file a table: fields, bounds, and what follows from one object alone.

Annotations are evaluated where they stand, not texts that pydantic would have to compile one by one.
"""
