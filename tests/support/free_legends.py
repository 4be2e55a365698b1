"""Detect legends that hide data, by pixels: the figure is drawn without legends, guides and axes, and what remains is data."""

import numpy as np

WHITE = 250  # of 255: lighter pixels count as background


def hidden(figure):
    """Return the titles of the panels whose legend lies over something that is drawn, or out of the figure."""
    panels = [axes for axes in figure.axes if axes.get_legend() is not None]
    figure.draw_without_rendering()
    boxes = {axes: axes.get_legend().get_window_extent() for axes in panels}
    layout = figure.get_layout_engine()
    figure.set_layout_engine("none")  # keep the layout while parts are hidden
    seen = [artist for axes in panels for artist in besides_data(axes) if artist.get_visible()]
    for artist in seen:
        artist.set_visible(False)
    figure.canvas.draw()
    paper = np.asarray(figure.canvas.buffer_rgba())[::-1, :, :3].min(axis=2) >= WHITE
    for artist in seen:
        artist.set_visible(True)
    figure.set_layout_engine(layout)
    return [name_of(axes) for axes, box in boxes.items() if not is_free(paper, box)]


def besides_data(axes):
    """Return what a panel shows besides its data: its legend, its frame and axes, and lines and areas all across it."""
    across = (axes.get_xaxis_transform(which="grid"), axes.get_yaxis_transform(which="grid"))
    guides = [artist for artist in (*axes.lines, *axes.patches) if artist.get_transform() in across]
    return [axes.get_legend(), axes.xaxis, axes.yaxis, *axes.spines.values(), *guides]


def is_free(paper, box):
    """True if all pixels of a box in the picture are background."""
    (left, bottom), (right, top) = np.ceil(box.min).astype(int), np.floor(box.max).astype(int)
    height, width = paper.shape
    return 0 <= left and right <= width and 0 <= bottom and top <= height and bool(paper[bottom:top, left:right].all())


def name_of(axes):
    """Return the name of a panel for messages."""
    return axes.get_title() or axes.get_title(loc="left") or axes.get_ylabel()
