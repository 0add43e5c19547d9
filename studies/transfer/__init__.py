"""How far a calibration carries over to scenes it was not made for."""
