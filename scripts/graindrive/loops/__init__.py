"""Time loops as Python sees them: GrainLoop for a scene of YADE's, what it carries over, and a run as a March."""
