"""Worlds in a periodic box."""

from __future__ import annotations

import math
from typing import Any, Sequence

import numpy as np
from numpy.typing import ArrayLike

from kds import _kds
from kds._arrays import Doubles, Ids, doubles, finite, flag, ids, number, vector, whole, word
from kds._bodies import MovingBodies
from kds._edits import MotionEdits
from kds._events import as_periodic_events
from kds._running import Running


class PeriodicWorld(Running, MovingBodies, MotionEdits):
    """Bodies in a box where what leaves at one end comes in at the other (docs/periodic.md): gases, suspensions.

    low, high: two corners (3,). degree: 1 for straight paths, 2 for parabolas too. Bodies bounce by their restitution
    and keep their orientation. Events have periodic_event_dtype; positions are in the box, up to a small slack.

    boundaries: of x, y, z (or one for all): 'periodic', 'walls' or 'open'. shear_rate (1/s): Lees-Edwards, the mean
    velocity in x grows by this for each unit of y. wall_restitution: 0 to 1. wall_temperatures (6,): 0 for walls that
    reflect, else they are thermostats, in units of mass * speed^2; `seed`: of what these draw. elastic_within (s): a
    contact of a body that has had another within this time is elastic, which inelastic gases need.
    broad_phase, gather, record, start_time, window, threads: as a World has them. Pictures have no images of bodies.

    A body has one piece of motion and 16 bits of category and mask, is no sensor, and has a bounding ball smaller than
    half of each period; what does not fit is refused with ValueError.
    """

    _made_of = _kds.PeriodicWorld
    _records = staticmethod(as_periodic_events)
    _turning = False

    def __init__(
        self,
        low: ArrayLike,
        high: ArrayLike,
        degree: int = 1,
        *,
        boundaries: str | Sequence[str] = "periodic",
        shear_rate: float = 0.0,
        wall_restitution: float = 1.0,
        wall_temperatures: ArrayLike = (0.0,) * 6,
        seed: int = 1,
        elastic_within: float = 0.0,
        broad_phase: str = "auto",
        gather: bool = True,
        record: bool = False,
        start_time: float = 0.0,
        window: float = math.inf,
        threads: int = 1,
    ) -> None:
        sides = [boundaries] * 3 if isinstance(boundaries, str) else boundaries
        if not isinstance(sides, (list, tuple)) or len(sides) != 3 or not all(isinstance(s, str) for s in sides):
            raise ValueError(f"boundaries: must be a string, or three of them, and is {boundaries!r}")
        self._options: dict[str, Any] = dict(
            degree=whole("degree", degree, 2**31 - 1),
            gather=flag("gather", gather),
            record=flag("record", record),
            min=vector("low", low),
            max=vector("high", high),
            boundaries=list(sides),
            shear_rate=number("shear_rate", shear_rate),
            wall_restitution=number("wall_restitution", wall_restitution),
            wall_temperatures=list(doubles("wall_temperatures", wall_temperatures, (6,))),
            seed=whole("seed", seed, 2**64 - 1),
            elastic_within=number("elastic_within", elastic_within),
            broad_phase=word("broad_phase", broad_phase),
            start_time=number("start_time", start_time),
            window=number("window", window),
            threads=whole("threads", threads),
        )
        self._core = _kds.PeriodicWorld(**self._options)

    @property
    def degree(self) -> int:
        """Of the paths."""
        return self._options["degree"]

    def step(self, limit: float) -> bool:
        """Processes the next event not later than `limit`, which is finite: bodies cross the ends for ever. False if
        there is none; then the clock is at `limit`."""
        return self._core.step(finite("limit", limit))

    @property
    def bodies(self) -> Ids:
        """The ids of all bodies (n,)."""
        return self._core.bodies()

    def crossings(self, bodies: ArrayLike | None = None) -> np.ndarray:
        """How many periods have been taken away from where the bodies would be, had they never been brought back (n,
        3), whole numbers: of these bodies, or of all, as `bodies` has them."""
        return self._core.crossings(self.bodies if bodies is None else ids("bodies", bodies))

    def unwrapped_positions(self, bodies: ArrayLike | None = None) -> Doubles:
        """Where the bodies would be, had they never been brought back (n, 3): for diffusion."""
        which = self.bodies if bodies is None else ids("bodies", bodies)
        return self.positions(which) + self._core.ways_wrapped(which)

    def __repr__(self) -> str:
        return f"<kds.PeriodicWorld: degree {self.degree}, {len(self)} bodies at {self.now} s>"
