"""The sheet made discrete: one class for each model, at rest, in motion and in its modes."""
