"""Time loops: replaces YADE's loop by GrainLoop and back, transfers contacts and settings, and defines `March`."""
