"""The objects of a scene, one file a table: fields, bounds, and properties that depend on one object alone.

Annotations are evaluated in place: as texts, pydantic would have to compile them one by one.
"""
