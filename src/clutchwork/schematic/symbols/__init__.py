"""The symbols, by what they show."""
