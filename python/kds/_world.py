"""Worlds of bodies that collide."""

from __future__ import annotations

import math
from typing import Any, Callable, NamedTuple, Sequence

import numpy as np
from numpy.typing import ArrayLike

from kds import _kds
from kds._arrays import (
    Doubles,
    Ids,
    column,
    doubles,
    flag,
    flags,
    identity,
    ids,
    masks,
    number,
    rows,
    vector,
    whole,
    word,
)
from kds._events import EventKind, as_events
from kds._kds import Shape

Filter = Callable[[int], bool]

_STILL = (0.0, 0.0, 0.0)
_UPRIGHT = (1.0, 0.0, 0.0, 0.0)

# Columns of the rows in which motions go to and from C++.
_POSITION, _VELOCITY, _ACCELERATION = slice(0, 3), slice(3, 6), slice(6, 9)
_TIME, _ORIENTATION, _ANGULAR_VELOCITY = 9, slice(10, 14), slice(14, 17)
_COLUMNS = 17


class Approach(NamedTuple):
    """When two centres are nearest, and how far apart then."""

    time: float
    distance: float


class Motion(NamedTuple):
    """A piece of a motion, from `start` (s) on. Velocities and accelerations are not halved."""

    start: float
    position: ArrayLike
    velocity: ArrayLike = _STILL
    acceleration: ArrayLike = _STILL
    orientation: ArrayLike = _UPRIGHT  #: of worlds that turn
    angular_velocity: ArrayLike = _STILL  #: rad/s, in the axes of the world


class World:
    """Moves bodies through time and finds their contacts, at exact times.

    degree: 1 for straight paths, 2 for parabolas too. turning: whether bodies turn (docs/turning.md); else they keep
    their orientation. Other arguments are the options of the C++ library (collision/world_options.hpp):

    response: 'none' (bodies pass through each other, contacts and separations are reported), 'elastic' (they bounce by
        restitution and rest on each other), 'callback' (functions that are called, see on(), change the motions).
    walls: (min, max), two points (3,): the bounding ball of each body is kept inside that box. wall_restitution: 0 to
        1.
    broad_phase: 'auto', 'grid', 'kinetic-sap', 'sap' (needs a rate, Hz) or 'all-pairs'. The events are the same.
    report_pairs: bounding volumes that begin and cease to overlap are events too.
    gather: whether events are kept for advance_to() and take_events().
    start_time: s. window: s; how far ahead events are predicted at a time. threads: 0 for as many as there are.

    Bodies are named by their ids, whole numbers: 0, 1, 2, ... as long as none has been removed, and none is given
    twice. An id that is not there (any more) is refused with ValueError, which says whether it has been removed.

    While the world runs and calls no function (on()), other Python threads go on; but one that asks or changes this
    world meanwhile gets RuntimeError.
    """

    def __init__(
        self,
        degree: int = 1,
        turning: bool = False,
        *,
        response: str = "none",
        walls: tuple[ArrayLike, ArrayLike] | None = None,
        wall_restitution: float = 1.0,
        broad_phase: str = "auto",
        report_pairs: bool = False,
        gather: bool = True,
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
    ) -> None:
        corners = None
        if walls is not None:
            corners = list(doubles("walls", walls, (2, 3)))
        self._options: dict[str, Any] | None = dict(
            degree=whole("degree", degree, 2**31 - 1),
            turning=flag("turning", turning),
            gather=flag("gather", gather),
            response=word("response", response),
            broad_phase=word("broad_phase", broad_phase),
            walls=corners,
            wall_restitution=number("wall_restitution", wall_restitution),
            start_time=number("start_time", start_time),
            window=number("window", window),
            rate=number("rate", rate),
            kdop=whole("kdop", kdop, 2**31 - 1),
            report_pairs=flag("report_pairs", report_pairs),
            threads=whole("threads", threads),
            zeno_contacts=whole("zeno_contacts", zeno_contacts, 2**32 - 1),
            zeno_interval=number("zeno_interval", zeno_interval),
            shortest_flight=number("shortest_flight", shortest_flight),
            orientation_error=number("orientation_error", orientation_error),
            most_edits=whole("most_edits", most_edits),
        )
        self._core = _kds.World(**self._options)
        self._degree = self._options["degree"]
        self._turning = self._options["turning"]

    @classmethod
    def _of_core(cls, core: Any, degree: int, turning: bool) -> World:
        world = cls.__new__(cls)
        world._core, world._options, world._degree, world._turning = core, None, degree, turning
        return world

    # ----- bodies

    def add_body(
        self,
        shape: Shape,
        position: ArrayLike,
        velocity: ArrayLike = _STILL,
        acceleration: ArrayLike = _STILL,
        *,
        orientation: ArrayLike = _UPRIGHT,
        angular_velocity: ArrayLike = _STILL,
        start: float | None = None,
        then: Sequence[Motion] = (),
        mass: float = 1.0,
        inertia: float | ArrayLike | None = None,
        fixed: bool = False,
        restitution: float = 1.0,
        friction: float = 0.0,
        tangential_restitution: float = 0.0,
        category: int = 1,
        collides_with: int = 0xFFFFFFFF,
        sensor: bool = False,
    ) -> int:
        """Adds a body; returns its id.

        position, velocity, acceleration, angular_velocity (rad/s): vectors (3,); orientation: a unit quaternion w, x,
        y, z. The motion is that from `start` (s) on, now if it is left out; a body with a start to come enters then.
        `then`: further pieces, each later than the one before. `inertia` (worlds that turn): a moment or a tensor (3,
        3), else that of a solid of the shape. Of two bodies the lower restitution and friction count. Two bodies may
        meet if the category of each shares a bit with collides_with of the other. A sensor reports, and passes through
        all.

        ValueError names what is wrong; then nothing is added. See collision/body_description.hpp.
        """
        tensor = None
        if inertia is not None and np.ndim(inertia) != 0:
            tensor, inertia = doubles("inertia", inertia, (3, 3)), None
        added = self._add(
            [shape],
            None,
            1,
            position=vector("position", position)[None],
            velocity=vector("velocity", velocity),
            acceleration=vector("acceleration", acceleration),
            orientation=doubles("orientation", orientation, (4,)),
            angular_velocity=vector("angular_velocity", angular_velocity),
            start=start,
            then=then,
            mass=number("mass", mass),
            inertia=0.0 if inertia is None else number("inertia", inertia),
            tensor=tensor,
            fixed=fixed,
            restitution=number("restitution", restitution),
            friction=number("friction", friction),
            tangential_restitution=number("tangential_restitution", tangential_restitution),
            category=category,
            collides_with=collides_with,
            sensor=sensor,
        )
        return int(added[0])

    def add_bodies(
        self,
        shapes: Shape | Sequence[Shape] | None,
        positions: ArrayLike,
        velocities: ArrayLike = _STILL,
        accelerations: ArrayLike = _STILL,
        *,
        radii: ArrayLike | None = None,
        orientations: ArrayLike = _UPRIGHT,
        angular_velocities: ArrayLike = _STILL,
        starts: ArrayLike | None = None,
        masses: ArrayLike = 1.0,
        inertias: ArrayLike = 0.0,
        fixed: ArrayLike = False,
        restitutions: ArrayLike = 1.0,
        frictions: ArrayLike = 0.0,
        tangential_restitutions: ArrayLike = 0.0,
        categories: ArrayLike = 1,
        collide_with: ArrayLike = 0xFFFFFFFF,
        sensors: ArrayLike = False,
    ) -> Ids:
        """Adds n bodies; returns their ids (n,), of uint64.

        shapes: one for all, or n; or None with `radii`, a number or (n,): balls. positions (n, 3). Of all others either
        (n, 3), orientations (n, 4), numbers (n,), or one for all. What they mean, add_body() says; inertias are
        moments, 0 for that of the shape.

        All are added or, if one is wrong, none: ValueError names it, bodies[17].
        """
        where = doubles("positions", positions, (None, 3))
        n = len(where)
        if (shapes is None) == (radii is None):
            raise ValueError("shapes: must be given, or else radii")
        several: list[Shape] = []
        if isinstance(shapes, Shape):
            several = [shapes]
        elif shapes is not None:
            several = list(shapes)
            if len(several) != n or not all(isinstance(shape, Shape) for shape in several):
                raise ValueError(f"shapes: must be a kds.Shape or {n} of them, as many as positions")
        return self._add(
            several,
            None if radii is None else column("radii", radii, n),
            n,
            position=where,
            velocity=rows("velocities", velocities, n, 3),
            acceleration=rows("accelerations", accelerations, n, 3),
            orientation=rows("orientations", orientations, n, 4),
            angular_velocity=rows("angular_velocities", angular_velocities, n, 3),
            start=None if starts is None else column("starts", starts, n),
            then=(),
            mass=column("masses", masses, n),
            inertia=column("inertias", inertias, n),
            tensor=None,
            fixed=fixed,
            restitution=column("restitutions", restitutions, n),
            friction=column("frictions", frictions, n),
            tangential_restitution=column("tangential_restitutions", tangential_restitutions, n),
            category=categories,
            collides_with=collide_with,
            sensor=sensors,
        )

    def _add(
        self,
        shapes: list[Shape],
        radii: Doubles | None,
        n: int,
        *,
        position: Any,
        velocity: Any,
        acceleration: Any,
        orientation: Any,
        angular_velocity: Any,
        start: Any,
        then: Sequence[Motion],
        mass: Any,
        inertia: Any,
        tensor: Any,
        fixed: Any,
        restitution: Any,
        friction: Any,
        tangential_restitution: Any,
        category: Any,
        collides_with: Any,
        sensor: Any,
    ) -> Ids:
        if any(not isinstance(shape, Shape) for shape in shapes):
            raise ValueError(f"shape: must be a kds.Shape, and is {shapes[0]!r}")
        motions = np.empty((n, _COLUMNS))
        motions[:, _POSITION] = position
        motions[:, _VELOCITY] = velocity
        motions[:, _ACCELERATION] = acceleration
        motions[:, _TIME] = self.now if start is None else start
        motions[:, _ORIENTATION] = orientation
        motions[:, _ANGULAR_VELOCITY] = angular_velocity
        numbers = np.empty((n, 5))
        for place, value in enumerate((mass, restitution, friction, tangential_restitution, inertia)):
            numbers[:, place] = value
        both = np.stack([masks("category", category, n), masks("collides_with", collides_with, n)], axis=1)
        bits = flags("fixed", fixed, n) + 2 * flags("sensor", sensor, n)
        if n == 0:
            return np.empty(0, np.uint64)
        return self._core.add(shapes, radii, motions, numbers, both, bits, tensor, self._pieces(then))

    @staticmethod
    def _pieces(pieces: Sequence[Motion]) -> Doubles:
        table = np.empty((len(pieces), _COLUMNS))
        for i, piece in enumerate(pieces):
            if not isinstance(piece, Motion):
                raise ValueError(f"then[{i}]: must be a kds.Motion, and is {piece!r}")
            table[i, _POSITION] = vector(f"then[{i}].position", piece.position)
            table[i, _VELOCITY] = vector(f"then[{i}].velocity", piece.velocity)
            table[i, _ACCELERATION] = vector(f"then[{i}].acceleration", piece.acceleration)
            table[i, _TIME] = number(f"then[{i}].start", piece.start)
            table[i, _ORIENTATION] = doubles(f"then[{i}].orientation", piece.orientation, (4,))
            table[i, _ANGULAR_VELOCITY] = vector(f"then[{i}].angular_velocity", piece.angular_velocity)
        return table

    def remove_body(self, body: int) -> None:
        """Removes a body. Its contacts end, with events where bodies pass through each other."""
        self._core.remove(identity("body", body))

    def update_motion(
        self,
        body: int,
        *,
        position: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
        acceleration: ArrayLike | None = None,
        orientation: ArrayLike | None = None,
        angular_velocity: ArrayLike | None = None,
    ) -> None:
        """Gives a body a new motion from now on; what is left out stays as it is now. Pieces to come are discarded."""
        one = {
            "positions": None if position is None else vector("position", position),
            "velocities": None if velocity is None else vector("velocity", velocity),
            "accelerations": None if acceleration is None else vector("acceleration", acceleration),
            "orientations": None if orientation is None else doubles("orientation", orientation, (4,)),
            "angular_velocities": None if angular_velocity is None else vector("angular_velocity", angular_velocity),
        }
        self.update_motions([identity("body", body)], **one)

    def update_motions(
        self,
        bodies: ArrayLike,
        *,
        positions: ArrayLike | None = None,
        velocities: ArrayLike | None = None,
        accelerations: ArrayLike | None = None,
        orientations: ArrayLike | None = None,
        angular_velocities: ArrayLike | None = None,
    ) -> None:
        """The same for n bodies, all or, if one is wrong, none: ids (n,), and (n, 3) or (3,), orientations (n, 4)."""
        which = ids("bodies", bodies)
        if orientations is not None and not self._turning:
            raise ValueError("orientation: bodies keep theirs in a world that is not turning")
        motions = self._core.motions_now(which, True)
        motions[:, _TIME] = self.now
        given = (
            ("positions", positions, _POSITION),
            ("velocities", velocities, _VELOCITY),
            ("accelerations", accelerations, _ACCELERATION),
            ("orientations", orientations, _ORIENTATION),
            ("angular_velocities", angular_velocities, _ANGULAR_VELOCITY),
        )
        for name, value, columns in given:
            if value is not None:
                motions[:, columns] = rows(name, value, len(which), columns.stop - columns.start)
        self._core.update(which, motions)

    def __len__(self) -> int:
        return self._core.size()

    def __contains__(self, body: object) -> bool:
        if not isinstance(body, (int, np.integer)) or not 0 <= body < 2**64:
            return False
        return self._core.contains(int(body))

    @property
    def bodies(self) -> Ids:
        """The ids of all bodies that have entered, or enter now (n,)."""
        return self.in_box((-math.inf,) * 3, (math.inf,) * 3)

    def _motions(self, bodies: ArrayLike | None) -> Doubles:
        return self._core.motions_now(self.bodies if bodies is None else ids("bodies", bodies), False)

    def positions(self, bodies: ArrayLike | None = None) -> Doubles:
        """Where the centres are now (n, 3): of these bodies, or of all, as `bodies` has them. Of one that is to enter
        later: where it will."""
        return self._motions(bodies)[:, _POSITION].copy()

    def velocities(self, bodies: ArrayLike | None = None) -> Doubles:
        """Their velocities (n, 3)."""
        return self._motions(bodies)[:, _VELOCITY].copy()

    def accelerations(self, bodies: ArrayLike | None = None) -> Doubles:
        """Their accelerations (n, 3), those by resting contacts included."""
        return self._motions(bodies)[:, _ACCELERATION].copy()

    def orientations(self, bodies: ArrayLike | None = None) -> Doubles:
        """Their orientations (n, 4): w, x, y, z."""
        return self._motions(bodies)[:, _ORIENTATION].copy()

    def angular_velocities(self, bodies: ArrayLike | None = None) -> Doubles:
        """Their angular velocities (n, 3), rad/s; of a body that precesses that of its present piece."""
        return self._motions(bodies)[:, _ANGULAR_VELOCITY].copy()

    def position(self, body: int) -> Doubles:
        """Where the centre of one body is now (3,)."""
        return self.positions([identity("body", body)])[0]

    def velocity(self, body: int) -> Doubles:
        """Its velocity (3,)."""
        return self.velocities([identity("body", body)])[0]

    def shape(self, body: int) -> Shape:
        """The shape that it was added with."""
        return self._core.shape(identity("body", body))

    def mass(self, body: int) -> float:
        """Its mass; of a fixed body too, which no contact moves."""
        return self._core.mass(identity("body", body))

    def fixed(self, body: int) -> bool:
        """Whether no other body changes its motion."""
        return self._core.fixed(identity("body", body))

    def sensor(self, body: int) -> bool:
        """Whether it only reports."""
        return self._core.sensor(identity("body", body))

    # ----- the clock

    @property
    def now(self) -> float:
        """The clock, s."""
        return self._core.now()

    @property
    def degree(self) -> int:
        return self._degree

    @property
    def turning(self) -> bool:
        return self._turning

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

    @property
    def next_time(self) -> float:
        """The time of the next event, s; inf if none will come. Now, if consequences of a change are not known yet."""
        return self._core.next_time()

    def take_events(self) -> np.recarray:
        """The events since the last were taken, in the order of time."""
        return as_events(self._core.take_events())

    def on(self, kind: EventKind, function: Callable[[np.record], Any] | None) -> None:
        """Has a function called at each event of this kind, with the event; None: no more.

        The function may add, remove and move bodies, those of the event too: in its time and place. What it raises ends
        the run after that event. It costs some microseconds an event, and other threads wait for the GIL as ever.
        """
        if function is None:
            return self._core.call_at(int(EventKind(kind)), None)
        if not callable(function):
            raise ValueError(f"function: must be callable, and is {function!r}")
        self._core.call_at(int(EventKind(kind)), lambda events: function(as_events(events)[0]))

    # ----- questions (docs/queries.md): nothing is changed

    def in_box(self, low: ArrayLike, high: ArrayLike) -> Ids:
        """The bodies whose bounding volumes meet a box now, its ends may be infinite."""
        return self._core.in_box(vector("low", low), vector("high", high))

    def cast(
        self,
        start: ArrayLike,
        end: ArrayLike,
        shape: Shape | None = None,
        *,
        orientation: ArrayLike = _UPRIGHT,
        filter: Filter | None = None,
    ) -> np.record | None:
        """What a ray from start to end (3,) hits first, or a shape whose centre goes that way; None if nothing.

        The hit is an event: a is the body, time the part of the way to it, from 0 to 1; point, normal, and feature_b of
        the body. `filter`: which bodies count, a function of the id.
        """
        hits = self._cast(start, end, shape, orientation, False, filter)
        return hits[0] if len(hits) else None

    def cast_all(
        self,
        start: ArrayLike,
        end: ArrayLike,
        shape: Shape | None = None,
        *,
        orientation: ArrayLike = _UPRIGHT,
        filter: Filter | None = None,
    ) -> np.recarray:
        """All that is hit on the way, each body once, by time."""
        return self._cast(start, end, shape, orientation, True, filter)

    def _cast(
        self,
        start: ArrayLike,
        end: ArrayLike,
        shape: Shape | None,
        orientation: ArrayLike,
        every: bool,
        filter: Filter | None,
    ) -> np.recarray:
        turned = doubles("orientation", orientation, (4,))
        return as_events(self._core.cast(shape, turned, vector("start", start), vector("end", end), every, filter))

    def overlapping(
        self,
        shape: Shape,
        position: ArrayLike,
        *,
        orientation: ArrayLike = _UPRIGHT,
        filter: Filter | None = None,
    ) -> Ids:
        """The bodies that a shape penetrates whose centre is at a point."""
        turned = doubles("orientation", orientation, (4,))
        return self._core.overlapping(shape, turned, vector("position", position), filter)

    def nearest(self, point: ArrayLike, count: int = 1, *, filter: Filter | None = None) -> np.recarray:
        """The bodies nearest to a point, nearest first, at most `count`: body, distance (0 inside) and point (3,), the
        nearest of the body."""
        return self._core.nearest(vector("point", point), whole("count", count), filter).view(np.recarray)

    def next_contact(
        self,
        shape: Shape,
        position: ArrayLike,
        velocity: ArrayLike = _STILL,
        acceleration: ArrayLike = _STILL,
        *,
        until: float,
        orientation: ArrayLike = _UPRIGHT,
        angular_velocity: ArrayLike = _STILL,
        filter: Filter | None = None,
    ) -> np.record | None:
        """The first body that a shape will meet, up to `until` (s), which is in no world and moves so from now on, as
        all move now; None if none. The hit has the time (s), a is the body, point and normal."""
        motion = np.empty((1, _COLUMNS))
        motion[0, _POSITION] = vector("position", position)
        motion[0, _VELOCITY] = vector("velocity", velocity)
        motion[0, _ACCELERATION] = vector("acceleration", acceleration)
        motion[0, _TIME] = self.now
        motion[0, _ORIENTATION] = doubles("orientation", orientation, (4,))
        motion[0, _ANGULAR_VELOCITY] = vector("angular_velocity", angular_velocity)
        hits = as_events(self._core.next_contact(shape, motion, number("until", until), filter))
        return hits[0] if len(hits) else None

    def next_contact_of(self, body: int, *, until: float, filter: Filter | None = None) -> np.record | None:
        """What a body will meet first, up to `until`, as all move now; None if nothing. a is the other body."""
        hits = as_events(self._core.next_contact_of(identity("body", body), number("until", until), filter))
        return hits[0] if len(hits) else None

    def next_contact_between(self, a: int, b: int, *, until: float) -> np.record | None:
        """When and where two bodies will meet, as they move now; None if they do not."""
        pair = identity("a", a), identity("b", b)
        hits = as_events(self._core.next_contact_between(*pair, number("until", until)))
        return hits[0] if len(hits) else None

    def closest_approach(self, a: int, b: int, *, until: float) -> Approach:
        """When the centres of two bodies are nearest, up to `until`, and how far apart then."""
        return Approach(*self._core.closest_approach(identity("a", a), identity("b", b), number("until", until)))

    def touching(self, a: int, b: int) -> bool:
        """Whether two bodies that pass through each other are in contact."""
        return self._core.touching(identity("a", a), identity("b", b))

    def resting(self, a: int, b: int) -> bool:
        """Whether two bodies rest on each other."""
        return self._core.resting(identity("a", a), identity("b", b))

    def resting_at_wall(self, body: int, wall: int) -> bool:
        """Whether a body rests at a wall: 0 is -x, 1 is +x, ... 5 is +z."""
        return self._core.resting_at_wall(identity("body", body), whole("wall", wall, 5))

    # ----- state

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

    def __reduce__(self) -> Any:
        if self._options is None:
            raise RuntimeError("World: one that Scene.world() has made cannot be pickled; save() and load() it")
        return _load_world, (self._options, self.save())

    @property
    def counters(self) -> dict[str, int]:
        """The work so far: contacts, pair_tests, motion_updates, ..."""
        return self._core.counters()

    @property
    def broad_phase(self) -> str:
        """The one in use."""
        return self._core.broad_phase()

    def audit(self) -> None:
        """Checks the world against brute force, in O(n^2); RuntimeError if it is wrong."""
        self._core.audit()

    def __repr__(self) -> str:
        kind = "turning, " if self._turning else ""
        return f"<kds.World: {kind}degree {self._degree}, {len(self)} bodies at {self.now} s>"


def _load_world(options: dict[str, Any], snapshot: bytes) -> World:
    world = World(
        options["degree"],
        options["turning"],
        **{key: value for key, value in options.items() if key not in ("degree", "turning")},
    )
    world.load(snapshot)
    return world
