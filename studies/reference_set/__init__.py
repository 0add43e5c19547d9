"""The reference set of `score`, computed anew."""
