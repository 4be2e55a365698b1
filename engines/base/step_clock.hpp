/// Time that does not drift: counted in steps from the last change of dt, never summed.
#pragma once
#include "engines/base/real.hpp"

namespace graindrive {

/// Time over which the clock was read, as (steps since the anchor) x dt + (time at the anchor).
///
/// O.time sums dt and is off by ~1e-12 of itself after ten million steps; this product is exact to round-off. The anchor moves
/// when dt changes, and when the step count jumps: back by O.resetTime, or on over steps without a reading, which do not count.
/// Time then continues from the end of the last step.
struct StepClock {
	long anchor_step = -1;  ///< step of the anchor; -1 before the first reading
	Real anchor_time = 0;   ///< time at the anchor [s]
	Real dt = 0;            ///< step since the anchor [s]
	long last_step = -1;

	bool started() const { return anchor_step >= 0; }

	/// Time at `step` [s]; 0 at the first reading.
	Real at(long step, Real present_dt)
	{
		const bool jumped = step != last_step && step != last_step + 1;
		if (!started() || present_dt != dt || jumped) {
			const Real reached = started() ? anchor_time + Real((jumped ? last_step + 1 : step) - anchor_step) * dt : 0;
			anchor_step = step;
			anchor_time = reached;
			dt = present_dt;
		}
		last_step = step;
		return anchor_time + Real(step - anchor_step) * dt;
	}

	Real next() const { return anchor_time + Real(last_step + 1 - anchor_step) * dt; }
};

}  // namespace graindrive
