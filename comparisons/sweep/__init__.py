"""One table of solves: a row for a model on a scene, kept in a campaign's store, and what the rows say."""
