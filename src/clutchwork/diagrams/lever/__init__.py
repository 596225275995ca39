"""The lever diagram: each gear set a lever, its members points at distances by its teeth."""
