"""The meaning of a scene's words, one for every model: regions, composition, kinematics, sentences."""
