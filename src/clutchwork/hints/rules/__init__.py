"""One file for each rule, or for rules that look at the same thing."""
