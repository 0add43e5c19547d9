"""From a tensile test to a law of rubber with its constants."""
