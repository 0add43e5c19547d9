"""Maps of the range in which each model holds, degrades, refuses or breaks, on published and extreme
scenes."""
