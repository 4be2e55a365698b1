"""What studies of a driven body record in the same way: blocks, frames, checkpoints, and the fields around the body."""

from . import fields, picture, recording


def record(p, folder, march, steps, block, sample, *, stage, ids, due, shown, settled, advice, label, units=None):
    """Run a scene with a driven body `steps` steps in blocks; return the rows that were tracked, arrays by name.

    p: parameters with the key `fields`. sample(done, track) notes what is measured after each block, and is asked at 0 too;
    it appends to the `recording.Track`, and a true answer ends the run. stage: facts for checkpoints, among them the id of
    the `body`. ids: those of the grains. shown: those of what is shown as base or walls. due: steps of the frames.
    settled(t): whether fields count from the time t on. advice: keys that may help against overlaps. units: those of the
    fields, see `fields.write_fields`.
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
