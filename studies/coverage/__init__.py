"""Whether the references' error bars hold: scenes drawn at random, each bar against its error."""
