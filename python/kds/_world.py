"""Worlds of bodies that collide."""

from __future__ import annotations

import copyreg
import math
from typing import Any

from numpy.typing import ArrayLike

from kds import _kds
from kds._arrays import doubles, flag, number, whole, word
from kds._bodies import Bodies
from kds._edits import Edits
from kds._queries import Queries
from kds._running import Running


class World(Running, Bodies, Edits, Queries):
    """Moves bodies through time and finds their contacts, at exact times.

    degree: 1 for straight paths, 2 for parabolas too, 3 to 5 for splines (docs/splines.md). turning: whether bodies
    turn (docs/turning.md), at degree 1 or 2; else they keep their orientation. domains: more than 1, or 0 for as many as
    are best, for a world that is run in parts by `threads` (docs/parallel.md): its events are the same. Such a world
    runs by advance_to() alone and calls no functions; to be asked or changed it is made one again, which takes as long
    as adding all bodies. Other arguments are the options of the C++ library (collision/world_options.hpp):

    response: 'none' (bodies pass through each other, contacts and separations are reported), 'elastic' (they bounce by
        restitution and rest on each other), 'callback' (functions that are called, see on(), change the motions).
    walls: (min, max), two points (3,): the bounding ball of each body is kept inside that box. wall_restitution: 0 to
        1.
    broad_phase: 'auto', 'grid', 'kinetic-sap', 'sap' (needs a rate, Hz) or 'all-pairs'. The events are the same.
    report_pairs: bounding volumes that begin and cease to overlap are events too. report_pieces: and pieces of motion
        that start, but the first of a body that is there from the beginning. Neither with domains.
    gather: whether events are kept for advance_to() and take_events(). record: whether what happens is recorded, from
        the first body on, for write_replay(), write_gltf() and write_vtk(); in some hundred bytes an event. Not with
        domains.
    profile: whether the CPU time of each kind of work is measured, for `profile`. Not with domains.
    start_time: s. window: s; how far ahead events are predicted at a time. threads: 0 for as many as there are.

    Bodies are named by their ids, whole numbers: 0, 1, 2, ... as long as none has been removed, and none is given
    twice. An id that is not there (any more) is refused with ValueError, which says whether it has been removed.

    While the world runs and calls no function (on()), other Python threads go on; but one that asks or changes this
    world meanwhile gets RuntimeError.
    """

    _made_of = _kds.World

    def __init__(
        self,
        degree: int = 1,
        turning: bool = False,
        *,
        domains: int = 1,
        response: str = "none",
        walls: tuple[ArrayLike, ArrayLike] | None = None,
        wall_restitution: float = 1.0,
        broad_phase: str = "auto",
        report_pairs: bool = False,
        report_pieces: bool = False,
        gather: bool = True,
        record: bool = False,
        start_time: float = 0.0,
        window: float = math.inf,
        rate: float = 0.0,
        kdop: int = 6,
        threads: int = 1,
        zeno_contacts: int = 100,
        zeno_interval: float = 1e-9,
        shortest_flight: float = 1e-3,
        orientation_error: float = 1e-3,
        most_edits: int = 1_000_000,
        profile: bool = False,
    ) -> None:
        corners = None
        if walls is not None:
            corners = list(doubles("walls", walls, (2, 3)))
        self._options: dict[str, Any] | None = dict(
            degree=whole("degree", degree, 2**31 - 1),
            turning=flag("turning", turning),
            domains=whole("domains", domains, 65535),
            gather=flag("gather", gather),
            record=flag("record", record),
            response=word("response", response),
            broad_phase=word("broad_phase", broad_phase),
            walls=corners,
            wall_restitution=number("wall_restitution", wall_restitution),
            start_time=number("start_time", start_time),
            window=number("window", window),
            rate=number("rate", rate),
            kdop=whole("kdop", kdop, 2**31 - 1),
            report_pairs=flag("report_pairs", report_pairs),
            report_pieces=flag("report_pieces", report_pieces),
            threads=whole("threads", threads),
            zeno_contacts=whole("zeno_contacts", zeno_contacts, 2**32 - 1),
            zeno_interval=number("zeno_interval", zeno_interval),
            shortest_flight=number("shortest_flight", shortest_flight),
            orientation_error=number("orientation_error", orientation_error),
            most_edits=whole("most_edits", most_edits),
            profile=flag("profile", profile),
        )
        if self._options["domains"] != 1:
            for option in ("report_pairs", "report_pieces"):
                if self._options[option]:
                    raise ValueError(f"{option}: must be False in a world in domains, whose events have none of these")
            if self._options["profile"]:
                raise ValueError("profile: must be False in a world in domains")
        self._core = _kds.World(**self._options)
        self._degree = self._options["degree"]
        self._turning = self._options["turning"]

    @classmethod
    def _of_core(cls, core: Any, degree: int, turning: bool) -> World:
        world = cls.__new__(cls)
        world._core, world._options, world._degree, world._turning = core, None, degree, turning
        return world

    @property
    def degree(self) -> int:
        return self._degree

    @property
    def turning(self) -> bool:
        return self._turning

    @property
    def next_time(self) -> float:
        """The time of the next event, s; inf if none will come. Now, if consequences of a change are not known yet.

        ValueError where bodies turn, or are found by 'sap': such a world looks ahead as far as advance_to() or
        step(limit) says, and not for ever."""
        return self._core.next_time()

    def set_timer(self, t: float) -> int:
        """Has an event TIMER happen at a time t (s) from now on, before the contacts of that time; on() says what is
        called then. Returns the number of the timer, 0, 1, 2, ..., which the event has as a and b."""
        return self._core.set_timer(number("t", t))

    def cancel_timer(self, timer: int) -> bool:
        """False if there is no such timer any more, or never was."""
        return self._core.cancel_timer(whole("timer", timer))

    @property
    def broad_phase(self) -> str:
        """The one in use."""
        return self._core.broad_phase()

    @property
    def profile(self) -> dict[str, float]:
        """CPU time so far, s, by kind of work: 'update' of bounding volumes and motions, 'sort', 'prune', 'test' of
        pairs, 'other'. All 0 unless the world was made with profile=True."""
        return self._core.profile()

    def __repr__(self) -> str:
        kind = "turning, " if self._turning else ""
        if self._options and self._options["domains"] != 1:
            kind = "in domains, "
        return f"<kds.World: {kind}degree {self._degree}, {len(self)} bodies at {self.now} s>"



def _with_shape(shape: _kds.Shape) -> Any:
    """How a shape is pickled: as a world of one body."""
    world = World()
    world.add_body(shape, (0, 0, 0), fixed=True)
    return _shape_of, (world.save(),)


def _shape_of(snapshot: bytes) -> _kds.Shape:
    world = World()
    world.load(snapshot)
    return world.shape(0)


copyreg.pickle(_kds.Shape, _with_shape)
