"""Homogeneous shear: stresses of one run, the friction law mu(I) and the area fraction phi(I) of a campaign."""
