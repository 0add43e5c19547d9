"""The meaning of a scene's words, the same to every model: regions, composition, kinematics, sentences."""
