"""The wiggle study: the figure and the film of a run, and the report of a campaign with the paper's figures and claims."""
