"""The parts of every answer: a document, tables of rows, figures and notes, and their forms on screen."""
