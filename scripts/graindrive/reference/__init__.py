"""The HTML reference: guides and READMEs, the Python package, and every engine's attributes, built by Sphinx."""
