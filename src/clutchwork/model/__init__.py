"""A model and its mistakes: numbers, laws, heat, and the structure that follows from its gears."""
