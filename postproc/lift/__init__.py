"""Lift study: forces on a body dragged through a bed, their figure, and the paper's claims."""
