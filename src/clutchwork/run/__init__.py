"""From a System to a Trajectory: the loop over the compiled core, controllers, and how runs end."""
