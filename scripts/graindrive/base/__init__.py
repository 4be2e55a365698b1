"""What every room uses: errors with exit codes, signals, output, files that appear whole."""
