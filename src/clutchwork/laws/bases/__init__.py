"""What several friction laws have in common."""
