"""The clock of a world, its events and its state."""

from __future__ import annotations

import math
from typing import Any, Callable

import numpy as np

from kds._arrays import number
from kds._events import EventKind, as_events, kind_of


class Running:
    """How a world of any kind runs."""

    _core: Any
    _records = staticmethod(as_events)

    @property
    def now(self) -> float:
        """The clock, s."""
        return self._core.now()

    def advance_to(self, t: float) -> np.recarray:
        """Processes everything up to and including t (s); returns the events since the last were taken (event_dtype).

        Ctrl-C ends it between two events, and the world can go on. What a function that is called raises comes out,
        after its event; then take_events() has the events so far. RuntimeError if called from within such a function.
        """
        self._core.advance_to(number("t", t))
        return self.take_events()

    def step(self, limit: float = math.inf) -> bool:
        """Processes the next event not later than `limit`. False if there is none; then the clock is at `limit`, if
        that is finite. What has happened, take_events() tells."""
        return self._core.step(number("limit", limit))

    def take_events(self) -> np.recarray:
        """The events since the last were taken, in the order of time."""
        return self._records(self._core.take_events())

    def on(self, kind: EventKind, function: Callable[[np.record], Any] | None) -> None:
        """Has a function called at each event of this kind, with the event; None: no more.

        The function may add, remove and move bodies, those of the event too: in its time and place. What it raises ends
        the run after that event. It costs some microseconds an event, and other threads wait for the GIL as ever.
        """
        number_of_kind = kind_of("kind", kind)
        if function is None:
            return self._core.call_at(number_of_kind, None)
        if not callable(function):
            raise ValueError(f"function: must be callable, and is {function!r}")
        records = self._records
        self._core.call_at(number_of_kind, lambda events: function(records(events)[0]))

    def save(self) -> bytes:
        """All that decides later events, as bytes, for the same program on the same kind of machine. Events not yet
        taken and functions that are called are not in it."""
        return self._core.save()

    def load(self, snapshot: bytes) -> None:
        """Goes back (or on) to a state that was saved of a world with the same options. RuntimeError, and nothing is
        changed, for bytes that are damaged or of another world."""
        if not isinstance(snapshot, bytes):
            raise ValueError(f"snapshot: must be bytes, and is {type(snapshot).__name__}")
        self._core.load(snapshot)

    @property
    def counters(self) -> dict[str, int]:
        """The work so far: contacts, pair_tests, motion_updates, ..."""
        return self._core.counters()

    def audit(self) -> None:
        """Checks the world against brute force, in O(n^2); RuntimeError if it is wrong."""
        self._core.audit()
