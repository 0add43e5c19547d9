"""Range in which each model holds, degrades, refuses or breaks: the verb `stability` on published, extreme
scenes.
"""
