"""What will be solved, in words, before anything is."""
