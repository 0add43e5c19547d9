"""Where models stand on the reference set."""
