"""Tools that all rooms use: errors with exit codes, signals, output, files that are written whole or not at all."""
