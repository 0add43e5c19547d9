"""Springs of a calibration from E, and the moduli that they meet."""
