"""Runs a study as a command (arguments, messages, exit codes) or from Python."""
