"""Speed for accuracy: vary a study's levers, measure what each changes and costs, and choose settings by that."""
