"""The stick diagram: a half section whose members are lines, laid out on a grid by a search for short ways."""
