"""The shape of every answer: a document, tables of rows, figures, notes, and all that follows from them."""
