"""How it is kept: campaigns of runs, their store, what carries them out, the manifest."""
