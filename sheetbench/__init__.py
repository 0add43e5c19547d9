"""How good is a spring lattice of a soft sheet, which k belongs to its E, and what does the speed cost?"""
