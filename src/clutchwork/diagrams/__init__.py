"""Pictures of gearboxes as SVG: stick diagram, lever diagram, speed plan."""
