"""Interactive pages: one HTML file with the core inside, with curves and sliders to drag."""
