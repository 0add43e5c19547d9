"""Other people's codes: parameters, meshes and files of a sheet in each code's format."""
