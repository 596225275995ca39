"""Pages that compute: one HTML file with the core inside, in which a reader moves knots and numbers."""
