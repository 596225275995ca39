"""What signals are made of: pieces over time, columns of CSV files."""
