"""A study as a command: arguments, endings, exit codes; runs started from Python."""
