"""Which model is the cheapest that is good enough for a scene."""
