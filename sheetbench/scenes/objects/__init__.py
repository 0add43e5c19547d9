"""The objects of a scene, table by table. Their annotations are no texts, which pydantic would compile."""
