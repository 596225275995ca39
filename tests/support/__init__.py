"""What several tests share: builders of drivelines and solvers that know nothing of clutchwork."""
