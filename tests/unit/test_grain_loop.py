"""From YADE's loop to GrainLoop and back: an error says what cannot be restored."""

import pytest
from graindrive import engines
from graindrive.loops import grain_loop
from graindrive.base.errors import UsageError
from yade import O


@pytest.fixture(autouse=True)
def scene():
    O.reset()
    yield
    O.reset()


def test_a_loop_of_unknown_origin_cannot_be_taken_back():
    O.engines = [engines.GrainLoop(label="by_hand")]
    with pytest.raises(UsageError, match="was not made for this scene by use_grain_loop"):
        grain_loop.use_yade_loop()
