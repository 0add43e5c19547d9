"""The language of scenes: units, keys, schema, faults in one line, TOML; depends on no object of a scene."""
