"""The cheapest model that is accurate enough for a scene."""
