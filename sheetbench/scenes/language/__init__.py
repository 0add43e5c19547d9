"""The language of scenes: units, keys, schema, faults in one line, TOML; knows no object of a scene."""
