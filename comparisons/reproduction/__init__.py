"""The study of Habibi et al. again: what was published, and what the same inputs give."""
