"""Legends that hide no data: each goes where its panel is free, else the panel grows, else it stands beside the panel."""

import numpy as np
from matplotlib.collections import PathCollection, QuadMesh
from matplotlib.transforms import Bbox

# matplotlib 3.6 has no public way to move a legend that is there: `_loc` and `codes` are what `legend(loc=…)` sets.
PLACES = ("upper right", "upper left", "lower right", "lower left", "center right", "center left")
PLACES += ("upper center", "lower center")
STEP, MOST = 0.04, 0.6  # of its height, by which a panel grows at a time, and at most
WIDE = 0.6  # of a figure: a panel that is wider stands alone in its row
PAD = 2.0  # pixels around a legend that stay free as well


def settle(figure):
    """Move the legends of all panels of a figure off their data; call it when all is drawn, before the figure is saved."""
    panels = [axes for axes in figure.axes if axes.get_legend() is not None and not is_beside(axes)]
    if not panels:
        return
    for axes in panels:
        axes.get_legend().set_in_layout(False)  # inside of its panel it takes no room of the layout
    figure.draw_without_rendering()  # the layout decides how large panels and legends are
    crowded = [axes for axes in panels if not placed(axes)]
    if not crowded:
        return
    for axes in crowded:
        make_room(axes)
    figure.draw_without_rendering()
    for axes in panels:  # a legend beside a panel, or a wider label, has made the panels smaller
        if covered(axes):
            placed(axes) or make_room(axes)


def placed(axes):
    """Put the legend of a panel where no data is, if there is such a place; return whether there is."""
    if not legend_fits(axes, 1.0):
        return False
    legend, given = axes.get_legend(), axes.get_legend()._loc
    for place in ([given] if given != 0 else []) + list(PLACES):
        legend._loc = place if isinstance(place, (int, tuple)) else legend.codes[place]
        if not covered(axes):
            return True
    return False


def make_room(axes):
    """Raise the upper end of a panel's y axis until its legend has room there; put it beside the panel if that is too much."""
    low, high = transformed(axes, axes.get_ylim())
    legend, grows = axes.get_legend(), axes.get_aspect() == "auto" and legend_fits(axes, MOST)
    for share in np.arange(STEP, MOST + STEP / 2, STEP) if grows else ():
        axes.set_ylim(untransformed(axes, (low, low + (high - low) / (1 - share))))
        for place in ("upper right", "upper left", "upper center"):
            legend._loc = legend.codes[place]
            if not covered(axes):
                return
    axes.set_ylim(untransformed(axes, (low, high)))
    put_beside(axes)


def legend_fits(axes, share):
    """True if a panel's legend is narrower than the panel and no higher than that share of its height."""
    box, panel = legend_box(axes), axes.get_window_extent()
    return box.width < panel.width and box.height < share * panel.height


def put_beside(axes):
    """Put the legend to the right of its panel; below it where the panel is as wide as its figure and would lose half of that."""
    legend = axes.get_legend()
    if axes.get_window_extent().width > WIDE * axes.figure.bbox.width:
        low = axes.get_tightbbox(axes.figure.canvas.get_renderer()).y0 - PAD  # below the labels
        legend._loc = legend.codes["upper center"]
        legend.set_bbox_to_anchor((0.5, axes.transAxes.inverted().transform((0, low))[1]), transform=axes.transAxes)
    else:
        legend._loc = legend.codes["upper left"]
        legend.set_bbox_to_anchor((1.01, 1.0), transform=axes.transAxes)
    legend.set_in_layout(True)


def is_beside(axes):
    """True if the legend of a panel stands where an anchor says, beside it."""
    return axes.get_legend()._bbox_to_anchor is not None


def legend_box(axes):
    """Return where the legend of a panel is, a Bbox in pixels, and a little around it."""
    return axes.get_legend().get_window_extent(axes.figure.canvas.get_renderer()).padded(PAD)


def covered(axes):
    """True if the legend of a panel hides any of its data."""
    box = legend_box(axes)
    return not is_beside(axes) and any(touches(artist, axes, box) for artist in data_of(axes))


def data_of(axes):
    """Return the artists of a panel that show data: all but lines and areas that follow the panel's edges, as axhline does."""
    found = [*axes.lines, *axes.collections, *axes.patches, *axes.images, *axes.texts]
    return [artist for artist in found if artist.get_visible() and not is_guide(artist, axes)]


def is_guide(artist, axes):
    """True for a line or an area that runs across the whole panel."""
    return artist.get_transform() in (axes.get_xaxis_transform(which="grid"), axes.get_yaxis_transform(which="grid"))


def touches(artist, axes, box):
    """True if an artist is drawn inside a Bbox in pixels."""
    if artist in axes.texts:
        return artist.get_window_extent().overlaps(box)
    if artist in axes.lines:
        return touches_line(artist, box)
    if artist in axes.patches:
        return path_meets(artist.get_path(), artist.get_transform(), box, filled=artist.get_fill())
    if artist in axes.images or isinstance(artist, QuadMesh):
        return artist.get_window_extent().overlaps(box)
    return touches_collection(artist, box)


def touches_line(line, box):
    """True if a line or one of its markers is drawn inside a Bbox in pixels."""
    path = line.get_transform().transform_path(line.get_path())
    if line.get_linestyle() not in ("None", "none", " ", "") and path_meets(path, None, box):
        return True
    if line.get_marker() in ("None", "none", None, "", " "):
        return False
    size = line.get_markersize() * line.figure.dpi / 72 / 2
    return bool(np.any(within(path.vertices, box.padded(size))))


def touches_collection(artist, box):
    """True if one of the shapes of a collection, or one of its points, is drawn inside a Bbox in pixels."""
    offsets = np.ma.getdata(artist.get_offsets())
    if len(offsets) and np.any(offsets) or isinstance(artist, PathCollection):
        return bool(np.any(within(artist.get_offset_transform().transform(offsets), box)))
    filled = len(artist.get_facecolor()) > 0
    return any(path_meets(path, artist.get_transform(), box, filled=filled) for path in artist.get_paths())


def path_meets(path, transform, box, *, filled=False):
    """True if a path meets a Bbox in pixels; places that are no numbers do not count."""
    path = path if transform is None else transform.transform_path(path)
    vertices = path.vertices[np.isfinite(path.vertices).all(axis=1)]
    if not len(vertices) or not Bbox([vertices.min(axis=0), vertices.max(axis=0)]).overlaps(box):
        return False
    return bool(path.intersects_bbox(box, filled=filled))


def within(points, box):
    """Return which of the points (n, 2) lie in a Bbox."""
    return np.all((points >= box.min) & (points <= box.max), axis=1)


def transformed(axes, values):
    """Return values of y as the axis has them, on a logarithmic one their logarithms."""
    return axes.yaxis.get_transform().transform(np.asarray(values, dtype=float))


def untransformed(axes, values):
    """Return values of y of what the axis has."""
    return axes.yaxis.get_transform().inverted().transform(np.asarray(values, dtype=float))
