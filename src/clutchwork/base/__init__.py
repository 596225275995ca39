"""Ground floor: errors that carry the remedy, values as messages show them, files that are opened with care."""
