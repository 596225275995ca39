"""Model files: reading, writing, the line of every mistake."""
