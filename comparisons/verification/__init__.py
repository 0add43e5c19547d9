"""Whether the references can be believed: published values, and the locking sweeps."""
