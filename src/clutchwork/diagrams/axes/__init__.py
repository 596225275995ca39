"""The drawing of gearboxes with parallel axes: shafts as lines, wheels on them, pairs in columns."""
