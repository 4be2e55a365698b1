"""Speed of GrainLoop against LAMMPS and YADE's loop, on scenes that are first shown to compute the same thing."""
