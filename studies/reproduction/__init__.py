"""Reproduction of the study of Habibi et al.: published values, and our results for the published inputs."""
