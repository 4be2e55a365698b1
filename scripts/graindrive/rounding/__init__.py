"""One scene with numbers of different length."""
