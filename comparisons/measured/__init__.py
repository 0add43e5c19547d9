"""What was measured, as people's files have it."""
