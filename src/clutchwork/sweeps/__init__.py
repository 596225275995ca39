"""Many runs of one driveline with other numbers, in one call: `clutchwork.sweep`."""
