"""A model, its mistakes, and the kinematics that follow from its gears."""
