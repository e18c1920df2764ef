"""The clock of a world, its events, its state, and pictures of it."""

from __future__ import annotations

import math
import os
from typing import Any, Callable

import numpy as np

from kds._arrays import number, path, word
from kds._events import EventKind, as_events, kind_of


class Running:
    """How a world of any kind runs."""

    _core: Any
    _made_of: Any  #: the class of the core
    _options: dict[str, Any] | None
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

    def advance_for(self, budget: float, t: float) -> bool:
        """Processes events up to t (s), until `budget` seconds of the wall clock have passed; True if t was reached.
        What has happened, take_events() tells: the same events as those of advance_to(), whatever the budgets.

        At least one event is processed, or a part of the work before it (less than a millisecond, as a rule). Not
        divided are functions that are called, and bodies that come to rest in a heap; in a PeriodicWorld only events
        are.
        """
        seconds = number("budget", budget)
        if not seconds >= 0:
            raise ValueError(f"budget: must be >= 0 s, and is {seconds}")
        return self._core.advance_for(seconds, number("t", t))

    def step(self, limit: float = math.inf) -> bool:
        """Processes the next event not later than `limit`. False if there is none; then the clock is at `limit`, if
        that is finite, as it has to be where bodies turn, and with 'sap'. What has happened, take_events() tells."""
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

    def __reduce_ex__(self, protocol: Any) -> Any:
        """Copies and pickles have the class and the attributes of the object, and of the world what save() has."""
        if self._options is None:
            raise RuntimeError("World: one that Scene.world() has made cannot be pickled; save() and load() it")
        # What Python does with objects of any class, but with a snapshot in place of the core. Attributes are in a
        # dictionary or, of classes that have __slots__, in a second one too.
        make, arguments, attributes, *_ = super().__reduce_ex__(2)
        members, slots = attributes if isinstance(attributes, tuple) else (attributes, {})
        return make, arguments, ({name: value for name, value in members.items() if name != "_core"}, slots, self.save())

    def __setstate__(self, state: tuple[dict[str, Any], dict[str, Any], bytes]) -> None:
        members, slots, snapshot = state
        self.__dict__.update(members)
        for name, value in slots.items():
            setattr(self, name, value)
        self._core = self._made_of(**members["_options"])
        self._core.load(snapshot)

    def write_replay(self, file: str | os.PathLike[str], title: str = "") -> None:
        """Writes a page that plays what has been recorded, up to now: one HTML file, for any browser.

        RuntimeError unless the world was made with record=True, and where three.js is not found. The title is the name
        of the file if it is left out. OSError for a file that cannot be written; it appears when it is complete.
        """
        self._core.write_replay(*_file_and_title(file, title))

    def write_gltf(self, file: str | os.PathLike[str], title: str = "", frames_per_second: float = 60) -> None:
        """Writes the same as an animation (glTF 2.0, for Blender and its like): straight paths have keys at their ends,
        all others so many a second. ValueError unless frames_per_second is finite and > 0."""
        self._core.write_gltf(*_file_and_title(file, title), number("frames_per_second", frames_per_second))

    def write_vtk(self, file: str | os.PathLike[str], frames_per_second: float = 60) -> None:
        """Writes the same as a series of surfaces, for ParaView: `file`, whose name ends in .pvd, and beside it a folder
        with the frames, so many a second."""
        self._core.write_vtk(path("file", file), number("frames_per_second", frames_per_second))

    @property
    def counters(self) -> dict[str, int]:
        """The work so far: contacts, pair_tests, motion_updates, ..."""
        return self._core.counters()

    def audit(self) -> None:
        """Checks the world against brute force, in O(n^2); RuntimeError if it is wrong."""
        self._core.audit()


def _file_and_title(file: str | os.PathLike[str], title: str) -> tuple[str, str]:
    name = path("file", file)
    return name, word("title", title) or os.path.basename(name)
