"""Which k belongs to E: the springs of a calibration and the moduli that they meet."""
