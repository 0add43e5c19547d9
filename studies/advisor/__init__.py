"""The advisor on scenes drawn at random."""
