"""The Magnus study: the figure of a run, and the report of a campaign with the paper's figures and claims."""
