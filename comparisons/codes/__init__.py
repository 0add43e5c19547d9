"""Other people's codes: the parameters, mesh and scene of a sheet in each code's own words."""
