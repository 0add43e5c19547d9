"""Campaigns of many solves, and one table of solves: a row for a model on a scene."""
