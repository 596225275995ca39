"""Speeds over all gears: the speed plan of Kutzbach, and a chart of each member."""
