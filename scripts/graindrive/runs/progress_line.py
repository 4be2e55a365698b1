"""Shows the progress of a running loop as a bar or as lines in a log: rate, and time left or kinetic energy of the grains."""

import sys
import time

import numpy as np

SILENCE = 30.0  # s of wall time after which a log gets a line even if no further tenth was reached


class Calming:
    """The progress of grains towards rest, used when the number of steps is not known in advance.

    `measure()` returns their kinetic energy, which must fall below `target`, both in `unit`. Progress is measured on a
    logarithmic scale from the highest energy to the target; if `least_steps` are required, they are the first half of it.
    """

    def __init__(self, measure, target, unit, least_steps=0):
        self.measure, self.target, self.unit, self.least_steps = measure, target, unit, least_steps
        self.energy, self.highest, self.share = np.inf, 0.0, 0.0

    def look(self, done):
        """Measure after `done` steps; return the progress so far, 0 to 1, which never decreases."""
        self.energy = self.measure()
        self.highest = max(self.highest, self.energy)
        self.share = max(self.share, self.way(done))
        return self.share

    def way(self, done):
        """Return the progress, 0 to 1, according to the last measurement, after `done` steps."""
        if self.least_steps == 0:
            return self.calmed()
        waited = done / self.least_steps
        return waited / 2 if waited < 1 else (1 + self.calmed()) / 2

    def calmed(self):
        """Return ln(highest/now) over ln(highest/target), within 0 to 1."""
        if self.energy <= self.target:
            return 1.0
        return float(np.log(self.highest / self.energy) / np.log(self.highest / self.target))

    def reached(self, done):
        """True if the last measured energy is below the target and `done` is at least `least_steps`."""
        return self.energy < self.target and done > self.least_steps

    def in_words(self):
        """Return the energy and its target as text."""
        return f"kinetic energy {self.energy:.2g} {self.unit}, target {self.target:.2g}"


class ProgressLine:
    """A bar on a terminal, one line per 10 % elsewhere, on stderr; both show the rate and the time left.

    `size` is the work of one step in `unit`; if it is 0, steps are counted. With an `aim`, a `Calming`, the percentage and the
    text of the aim are shown in place of the time left, which is then unknown.
    """

    def __init__(self, total_steps, size, label, aim=None, unit="particle-steps"):
        self.total, self.size, self.label, self.aim = total_steps, size, label, aim
        self.unit = unit if size else "steps"
        self.done, self.tenths, self.bar, self.start = 0, 0, None, time.perf_counter()
        self.told = self.start

    def __enter__(self):
        if sys.stderr.isatty():
            from tqdm import tqdm

            words = "{rate_fmt}, {remaining} left" if self.aim is None else "{postfix}, {elapsed} so far"
            self.bar = tqdm(
                total=self.total * (self.size or 1) if self.aim is None else 1.0,
                desc=self.label,
                unit=f" {self.unit}",
                unit_scale=True,
                bar_format="{desc} {percentage:3.0f} % |{bar}| " + words,
            )
        return self

    def update(self, done):
        """Show that `done` steps of the total are done."""
        if self.aim is not None:
            self.show_aim(done)
        elif self.bar is not None:
            self.bar.update((done - self.done) * (self.size or 1))
        elif self.total and 10 * done // self.total > self.tenths:
            self.tell(10 * done // self.total, self.rate_and_time_left(done))
        self.done = done

    def show_aim(self, done):
        """Show the progress of the aim; in a log also if it has not changed for `SILENCE` seconds."""
        before, now = self.aim.share, self.aim.look(done)
        words = f"{self.aim.in_words()}, {self.rate(done)}"
        if self.bar is not None:
            self.bar.set_postfix_str(words, refresh=False)
            self.bar.update(now - before)
        elif int(10 * now) > self.tenths or time.perf_counter() - self.told > SILENCE:
            self.tell(int(10 * now), words)

    def tell(self, tenths, words):
        """Print a line with `tenths` of the progress."""
        self.tenths, self.told = tenths, time.perf_counter()
        print(f"{self.label}: {10 * tenths:3d} %, {words}", file=sys.stderr, flush=True)

    def rate(self, done):
        """Return the mean rate so far as text."""
        rate = done / self.elapsed()
        return f"{rate * self.size / 1e6:.3g} M {self.unit}/s" if self.size else f"{rate:.3g} steps/s"

    def rate_and_time_left(self, done):
        """Return the mean rate so far and the time left at that rate as text."""
        left = self.elapsed() * (self.total - done) / done
        return f"{self.rate(done)}, {int(left) // 60}:{int(left) % 60:02d} left"

    def elapsed(self):
        """Return the seconds since the line was made, always > 0."""
        return max(time.perf_counter() - self.start, 1e-9)

    def __exit__(self, *_):
        if self.bar is not None:
            self.bar.close()
