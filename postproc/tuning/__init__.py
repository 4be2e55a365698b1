"""What a tuning found, as figure, table and plain sentences."""
