"""How near other simulators come with what we export for them."""
