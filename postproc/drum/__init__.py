"""The rotating drum: the analysis that grains and continuum share, the figure of a run, the report of a campaign."""
