"""Laws of rubber, with their constants, from tensile tests."""
