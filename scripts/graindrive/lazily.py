"""Imports on first use: help, plans of campaigns and checks of parameters need neither YADE nor matplotlib.

`engines` stands for `graindrive.engines`; a study names its figure, film and report in the same way.
"""

import importlib


class Lazily:
    """A placeholder for a module, or for an attribute of a module, which is imported on first use.

    `name` is the module's full name, `attribute` a name in it. A test whether the object is None imports nothing.
    """

    def __init__(self, name, attribute=""):
        self._place = name, attribute

    def __getattr__(self, name):
        return getattr(self._meant(), name)

    def __call__(self, *arguments, **keywords):
        return self._meant()(*arguments, **keywords)

    def _meant(self):
        module, attribute = self._place
        found = importlib.import_module(module)
        return getattr(found, attribute) if attribute else found


engines = Lazily("graindrive.engines")
