"""The study of Habibi et al. in depth: what its figures contradict, and which sheets come nearest to them."""
