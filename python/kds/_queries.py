"""Questions to a world (docs/queries.md): nothing is changed."""

from __future__ import annotations

from typing import Callable, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from kds import _kds
from kds._arrays import Doubles, Ids, doubles, finite, identity, number, shape_of, vector, whole, word
from kds._events import as_events
from kds._kds import Shape
from kds._motion import (
    ACCELERATION,
    ANGULAR_VELOCITY,
    COLUMNS,
    HIGHER,
    NOTHING,
    ORIENTATION,
    POSITION,
    STILL,
    TIME,
    UPRIGHT,
    VELOCITY,
    higher_terms,
)

Filter = Callable[[int], bool]


class Approach(NamedTuple):
    """When two centres are nearest, and how far apart then."""

    time: float
    distance: float


class Distance(NamedTuple):
    """How far apart two bodies or shapes are, 0 where they have a point in common, and the nearest point (3,) of each."""

    distance: float
    of_a: np.ndarray
    of_b: np.ndarray


def shape_distance(
    a: Shape,
    b: Shape,
    position: ArrayLike,
    *,
    orientation_a: ArrayLike = UPRIGHT,
    orientation_b: ArrayLike = UPRIGHT,
    time: float = 0.0,
) -> Distance:
    """How far apart two shapes are that are in no world: a with its centre in the origin, b with its centre at
    `position` (3,), each in its orientation (4,), and the nearest point (3,) of each. Meshes are surfaces, all others
    solid; meshes that bend are as they are at `time` (s)."""
    return Distance(
        *_kds.shape_distance(
            shape_of("a", a),
            doubles("orientation_a", orientation_a, (4,)),
            shape_of("b", b),
            doubles("orientation_b", orientation_b, (4,)),
            vector("position", position),
            finite("time", time),
        )
    )


def _checked(filter: Filter | None) -> Filter | None:
    """The filter for C++, where True and False are the only answers."""
    if filter is None:
        return None
    if not callable(filter):
        raise ValueError(f"filter: must be a function of the id of a body, or None, and is {filter!r}")
    return lambda body: bool(filter(body))


def _first(hits: np.ndarray) -> np.record | None:
    return as_events(hits)[0] if len(hits) else None


class Queries:
    """What a World is asked."""

    _core: _kds.World

    def in_box(self, low: ArrayLike, high: ArrayLike) -> Ids:
        """The bodies whose bounding volumes meet a box now, its ends may be infinite."""
        return self._core.in_box(vector("low", low), vector("high", high))

    def in_moving_box(
        self,
        low: ArrayLike,
        high: ArrayLike,
        velocity: ArrayLike = STILL,
        acceleration: ArrayLike = STILL,
        *,
        until: float,
    ) -> Ids:
        """The bodies whose bounding boxes, on the ways that they have from now to `until` (s), meet a box on its way:
        `low` and `high` are its corners now. Some are among them that it only comes near."""
        motion = self._moved(low, velocity, acceleration, UPRIGHT, STILL, NOTHING)
        extent = vector("high", high) - vector("low", low)
        if not (extent >= 0).all():
            raise ValueError("high: must not be below low")
        return self._core.in_moving_box(motion, extent, number("until", until))

    def cast(
        self,
        start: ArrayLike,
        end: ArrayLike,
        shape: Shape | None = None,
        *,
        orientation: ArrayLike = UPRIGHT,
        filter: Filter | None = None,
    ) -> np.record | None:
        """What a ray from start to end (3,) hits first, or a shape whose centre goes that way; None if nothing.

        The hit is an event: a is the body, time the part of the way to it, from 0 to 1; point, normal, and feature_b of
        the body. `filter`: which bodies count, a function of the id.
        """
        return _first(self._cast(start, end, shape, orientation, False, filter))

    def cast_all(
        self,
        start: ArrayLike,
        end: ArrayLike,
        shape: Shape | None = None,
        *,
        orientation: ArrayLike = UPRIGHT,
        filter: Filter | None = None,
    ) -> np.recarray:
        """All that is hit on the way, each body once, by time."""
        return as_events(self._cast(start, end, shape, orientation, True, filter))

    def _cast(
        self,
        start: ArrayLike,
        end: ArrayLike,
        shape: Shape | None,
        orientation: ArrayLike,
        every: bool,
        filter: Filter | None,
    ) -> np.ndarray:
        turned = doubles("orientation", orientation, (4,))
        return self._core.cast(
            None if shape is None else shape_of("shape", shape),
            turned,
            vector("start", start),
            vector("end", end),
            every,
            _checked(filter),
        )

    def overlapping(
        self,
        shape: Shape,
        position: ArrayLike,
        *,
        orientation: ArrayLike = UPRIGHT,
        filter: Filter | None = None,
    ) -> Ids:
        """The bodies that a shape penetrates whose centre is at a point. Not of a half-space: what is in that,
        next_contacts() tells, with `until` now."""
        turned = doubles("orientation", orientation, (4,))
        return self._core.overlapping(
            shape_of("shape", shape), turned, vector("position", position), _checked(filter)
        )

    def nearest(
        self,
        point: ArrayLike,
        count: int = 1,
        shape: Shape | None = None,
        *,
        orientation: ArrayLike = UPRIGHT,
        filter: Filter | None = None,
    ) -> np.recarray:
        """The bodies nearest to a point, or to a shape whose centre is there, nearest first, at most `count`: body,
        distance (0 inside, or where they overlap), point (3,), the nearest of the body, and from_point (3,), the nearest
        of the shape, or the point itself."""
        return self._core.nearest(
            None if shape is None else shape_of("shape", shape),
            doubles("orientation", orientation, (4,)),
            vector("point", point),
            whole("count", count),
            _checked(filter),
        ).view(np.recarray)

    def distance_between(self, a: int, b: int) -> Distance:
        """How far apart two bodies are now, and where they are nearest to each other. ValueError for one that is to
        enter later."""
        return Distance(*self._core.distance_between(identity("a", a), identity("b", b)))

    def next_contact(
        self,
        shape: Shape,
        position: ArrayLike,
        velocity: ArrayLike = STILL,
        acceleration: ArrayLike = STILL,
        *,
        until: float,
        orientation: ArrayLike = UPRIGHT,
        angular_velocity: ArrayLike = STILL,
        higher: ArrayLike = NOTHING,
        filter: Filter | None = None,
    ) -> np.record | None:
        """The first body that a shape will meet, up to `until` (s), which is in no world and moves so from now on, as
        all move now; None if none. The hit has the time (s), a is the body, point and normal."""
        motion = self._moved(position, velocity, acceleration, orientation, angular_velocity, higher)
        ends = number("until", until)
        return _first(self._core.next_contact(shape_of("shape", shape), motion, ends, _checked(filter)))

    def next_contacts(
        self,
        shape: Shape,
        position: ArrayLike,
        velocity: ArrayLike = STILL,
        acceleration: ArrayLike = STILL,
        *,
        until: float,
        orientation: ArrayLike = UPRIGHT,
        angular_velocity: ArrayLike = STILL,
        higher: ArrayLike = NOTHING,
        filter: Filter | None = None,
    ) -> np.recarray:
        """All bodies that it will meet, each once, by time: of a place that stands still, who enters it before then."""
        motion = self._moved(position, velocity, acceleration, orientation, angular_velocity, higher)
        ends = number("until", until)
        return as_events(self._core.next_contacts(shape_of("shape", shape), motion, ends, _checked(filter)))

    def _moved(
        self,
        position: ArrayLike,
        velocity: ArrayLike,
        acceleration: ArrayLike,
        orientation: ArrayLike,
        angular_velocity: ArrayLike,
        higher: ArrayLike,
    ) -> Doubles:
        """A motion from now on."""
        motion = np.empty((1, COLUMNS))
        motion[0, POSITION] = vector("position", position)
        motion[0, VELOCITY] = vector("velocity", velocity)
        motion[0, ACCELERATION] = vector("acceleration", acceleration)
        motion[0, TIME] = self._core.now()
        motion[0, ORIENTATION] = doubles("orientation", orientation, (4,))
        motion[0, ANGULAR_VELOCITY] = vector("angular_velocity", angular_velocity)
        motion[0, HIGHER] = higher_terms("higher", higher, ())
        return motion

    def next_contact_of(
        self, body: int, *, until: float, filter: Filter | None = None, mode: str = "resolved"
    ) -> np.record | None:
        """What a body will meet first, up to `until`, as all move now; None if nothing. a is the other body.

        mode: 'resolved': what it touches now is met only if the two approach each other; 'transparent': what it overlaps
        is met now.
        """
        ends = number("until", until)
        body_id = identity("body", body)
        return _first(self._core.next_contact_of(body_id, ends, _checked(filter), word("mode", mode)))

    def next_contacts_of(
        self, body: int, *, until: float, filter: Filter | None = None, mode: str = "resolved"
    ) -> np.recarray:
        """All that it will meet, each once, by time."""
        ends = number("until", until)
        body_id = identity("body", body)
        return as_events(self._core.next_contacts_of(body_id, ends, _checked(filter), word("mode", mode)))

    def next_contact_between(self, a: int, b: int, *, until: float, mode: str = "resolved") -> np.record | None:
        """When and where two bodies will meet, as they move now; None if they do not."""
        pair = identity("a", a), identity("b", b)
        return _first(self._core.next_contact_between(*pair, number("until", until), word("mode", mode)))

    def closest_approach(self, a: int, b: int, *, until: float) -> Approach:
        """When the centres of two bodies are nearest, up to `until`, and how far apart then. ValueError for one that is
        to enter later."""
        return Approach(*self._core.closest_approach(identity("a", a), identity("b", b), number("until", until)))

    def pairs_nearer_than(self, distance: float, *, until: float, filter: Filter | None = None) -> np.recarray:
        """All pairs of bodies whose centres will come nearer to each other than `distance`, up to `until`, as all move
        now: a, b, time (s) and distance of their closest approach, by time."""
        found = self._core.pairs_nearer_than(number("distance", distance), number("until", until), _checked(filter))
        return found.view(np.recarray)

    def contact_pairs(self) -> Ids:
        """All pairs of bodies that touch or rest on each other now (n, 2)."""
        return self._core.contact_pairs()

    def partners(self, body: int) -> Ids:
        """The bodies that a body touches or rests on, as touching() and resting() say (n,)."""
        return self._core.partners(identity("body", body))

    def touching(self, a: int, b: int) -> bool:
        """Whether two bodies that pass through each other are in contact."""
        return self._core.touching(identity("a", a), identity("b", b))

    def resting(self, a: int, b: int) -> bool:
        """Whether two bodies rest on each other."""
        return self._core.resting(identity("a", a), identity("b", b))

    def resting_at_wall(self, body: int, wall: int) -> bool:
        """Whether a body rests at a wall: 0 is -x, 1 is +x, ... 5 is +z."""
        return self._core.resting_at_wall(identity("body", body), whole("wall", wall, 5))
