"""The seed's study again: what was published, what the same inputs give, and what comes nearest to it."""
