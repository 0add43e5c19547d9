"""Models of one scene side by side, at rest and in motion: differences, and which exceed the error bars."""
