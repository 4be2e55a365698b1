"""Compares the speed of GrainLoop with LAMMPS and YADE's loop, on scenes for which all codes give the same results."""
