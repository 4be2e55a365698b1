"""Post-processing: the only readers of run folders. Nothing here starts a run, and no figure needs one to be repeated."""
