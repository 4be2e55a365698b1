"""What a person sees of a running loop: a bar, or lines in a log, with the rate, and the time left or how calm grains are."""

import sys
import time

import numpy as np

SILENCE = 30.0  # s of wall time after which a log gets a line although there is no further tenth


class Calming:
    """How far grains are on their way to rest, where nobody knows how many steps that takes.

    `measure()` gives their kinetic energy, `target` what it must fall below, both in `unit`. The way is the energy's from
    its highest value to the target, on a logarithmic scale; if it takes `least_steps`, those are the first half.
    """

    def __init__(self, measure, target, unit, least_steps=0):
        self.measure, self.target, self.unit, self.least_steps = measure, target, unit, least_steps
        self.energy, self.highest, self.share = np.inf, 0.0, 0.0

    def look(self, done):
        """Measure after `done` steps; return the share of the way so far, which never falls."""
        self.energy = self.measure()
        self.highest = max(self.highest, self.energy)
        self.share = max(self.share, self.way(done))
        return self.share

    def way(self, done):
        """Return the share of the way by what was measured after `done` steps."""
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
        """True if the energy that was measured last is below the target, and `done` steps are enough."""
        return self.energy < self.target and done > self.least_steps

    def in_words(self):
        """Return the energy and its target."""
        return f"kinetic energy {self.energy:.2g} {self.unit}, to fall below {self.target:.2g}"


class ProgressLine:
    """A bar on a terminal, one line per 10 % elsewhere, on stderr; both show the rate and the time left.

    `size` is the work of one step in `unit`; of 0 steps alone are counted. With an `aim`, a `Calming`, the per cent are its
    own and its words stand in place of the time left, which nobody knows.
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
        """Show that `done` steps of the total are run."""
        if self.aim is not None:
            self.show_aim(done)
        elif self.bar is not None:
            self.bar.update((done - self.done) * (self.size or 1))
        elif self.total and 10 * done // self.total > self.tenths:
            self.tell(10 * done // self.total, self.rate_and_time_left(done))
        self.done = done

    def show_aim(self, done):
        """Show how far the aim is; in a log also where it came no further for long."""
        before, now = self.aim.share, self.aim.look(done)
        words = f"{self.aim.in_words()}, {self.rate(done)}"
        if self.bar is not None:
            self.bar.set_postfix_str(words, refresh=False)
            self.bar.update(now - before)
        elif int(10 * now) > self.tenths or time.perf_counter() - self.told > SILENCE:
            self.tell(int(10 * now), words)

    def tell(self, tenths, words):
        """Print a line, at so many tenths."""
        self.tenths, self.told = tenths, time.perf_counter()
        print(f"{self.label}: {10 * tenths:3d} %, {words}", file=sys.stderr, flush=True)

    def rate(self, done):
        """Return in words the mean rate so far."""
        rate = done / self.elapsed()
        return f"{rate * self.size / 1e6:.3g} M {self.unit}/s" if self.size else f"{rate:.3g} steps/s"

    def rate_and_time_left(self, done):
        """Return in words the mean rate so far and the time left at that rate."""
        left = self.elapsed() * (self.total - done) / done
        return f"{self.rate(done)}, {int(left) // 60}:{int(left) % 60:02d} left"

    def elapsed(self):
        """Return the seconds since the line was made, never 0."""
        return max(time.perf_counter() - self.start, 1e-9)

    def __exit__(self, *_):
        if self.bar is not None:
            self.bar.close()
