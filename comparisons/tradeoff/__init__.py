"""Error against cost over models of a scene, and the cheapest model within a tolerance."""
