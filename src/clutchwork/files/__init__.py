"""Model files: read, written, with the line of every mistake."""
