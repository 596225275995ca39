"""From a model to the frozen System that the core reads."""
