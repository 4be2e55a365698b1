"""Records runs with a driven body: blocks, frames, checkpoints, and the fields around the body."""

from . import fields, picture, recording


def record(p, folder, march, steps, block, sample, *, stage, ids, due, shown, settled, advice, label, units=None):
    """Run a scene with a driven body for `steps` steps in blocks; return the tracked rows, arrays by name.

    p: parameters with the key `fields`. sample(done, track) is called after each block, and at step 0 too; it appends a
    row of measured values to the `recording.Track`, and ends the run if it returns true. stage: facts for checkpoints, among
    them the id of the `body`. ids: ids of the grains. shown: ids of the disks shown as base or walls. due: steps of the
    frames. settled(t): true if the fields are averaged from the time t on. advice: keys that may help against overlaps.
    units: units of the fields, see `fields.write_fields`.
    """
    from yade import O

    around, track = O.labeledEngine("around") if p.fields else None, recording.Track(folder)
    frames = recording.Frames(folder, due, lambda: picture.taken(ids, shown, stage["body"]))

    def after_block(done):
        ended = sample(done, track)
        if around:
            around.dead = not settled(march.time)
        return ended

    with recording.overlap_advice(advice):
        recording.run_sampled(
            folder, march, steps, block, after_block, track=track, frames=frames, stage=stage, label=label
        )
    if around:
        fields.write_fields(folder, "around", around, units)
    return track.arrays()
