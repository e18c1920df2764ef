"""The bodies of a world: added, and looked at."""

from __future__ import annotations

import math
from typing import Any, Iterable, NamedTuple, Sequence

import numpy as np
from numpy.typing import ArrayLike

from kds import _kds
from kds._arrays import (
    Doubles,
    Ids,
    array_of,
    column,
    doubles,
    flags,
    identity,
    ids,
    number,
    rows,
    shape_of,
    unsigned,
    vector,
)
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
    Motion,
    higher_terms,
    pieces,
    scripts,
)


class FreeTurning(NamedTuple):
    """How a body turns at a time: (4,), of length 1 but for roundings, and (3,), in the axes of the world."""

    orientation: np.ndarray  #: w, x, y, z
    angular_velocity: np.ndarray  #: rad/s
    angular_momentum: np.ndarray  #: about the centre of mass; mass * length^2 / s


class MovingBodies:
    """How bodies come into a world of any kind, and how they move there."""

    _core: Any

    def add_body(
        self,
        shape: Shape,
        position: ArrayLike | Motion,
        velocity: ArrayLike = STILL,
        acceleration: ArrayLike = STILL,
        *,
        orientation: ArrayLike = UPRIGHT,
        angular_velocity: ArrayLike = STILL,
        higher: ArrayLike = NOTHING,
        start: float | None = None,
        then: Motion | Sequence[Motion] = (),
        mass: float = 1.0,
        inertia: float | ArrayLike | None = None,
        fixed: bool = False,
        restitution: float = 1.0,
        friction: float = 0.0,
        tangential_restitution: float = 0.0,
        rolling_friction: float = 0.0,
        category: int = 1,
        collides_with: int = 0xFFFFFFFF,
        group: int = 0,
        sensor: bool = False,
        self_contacts: bool = False,
        user_data: int = 0,
    ) -> int:
        """Adds a body; returns its id.

        position, velocity, acceleration, angular_velocity (rad/s): vectors (3,); orientation: a unit quaternion w, x,
        y, z; `higher` (k, 3), in worlds of degree 3 to 5: coefficients of (t - start)^3 and on. The motion is that from
        `start` (s) on, now if it is left out; a body with a start to come enters then. `then`: further pieces, each
        later than the one before. A Motion as `position` is the whole motion, in one piece or several, and stands for
        all of these. `inertia` (worlds that turn): a moment or a tensor (3,
        3), else that of a solid of the shape. Of two bodies the lower restitution and friction count. Two bodies may
        meet if the category of each shares a bit with collides_with of the other, and their group is not the same, or
        0. A sensor reports, and passes through all. self_contacts: of a mesh that bends, whether its contacts with itself
        are events, too, of the body with itself; in every mode it goes on through itself. user_data: a number of 64 bits of your own, which events carry.

        ValueError names what is wrong; then nothing is added. See collision/body_description.hpp.
        """
        tensor = None
        if inertia is not None and array_of("inertia", inertia).ndim != 0:
            tensor, inertia = doubles("inertia", inertia, (3, 3)), None
        if isinstance(position, Motion):
            for name, value, left_out in (
                ("velocity", velocity, STILL),
                ("acceleration", acceleration, STILL),
                ("orientation", orientation, UPRIGHT),
                ("angular_velocity", angular_velocity, STILL),
                ("higher", higher, NOTHING),
                ("start", start, None),
                ("then", then, ()),
            ):
                if value is not left_out:
                    raise ValueError(f"{name}: must be left out where position is a kds.Motion: that has all pieces")
            motions, later = _whole_motion("position", position)
        else:
            motions = np.empty((1, COLUMNS))
            motions[:, POSITION] = vector("position", position)
            motions[:, VELOCITY] = vector("velocity", velocity)
            motions[:, ACCELERATION] = vector("acceleration", acceleration)
            motions[:, TIME] = self._core.now() if start is None else number("start", start)
            motions[:, ORIENTATION] = doubles("orientation", orientation, (4,))
            motions[:, ANGULAR_VELOCITY] = vector("angular_velocity", angular_velocity)
            motions[:, HIGHER] = higher_terms("higher", higher, ())
            later = scripts("then", then, motions[:, TIME])
        added = self._add(
            [shape_of("shape", shape)],
            None,
            motions,
            later,
            mass=number("mass", mass),
            inertia=0.0 if inertia is None else number("inertia", inertia),
            tensor=tensor,
            fixed=flags("fixed", fixed, 1),
            restitution=number("restitution", restitution),
            friction=number("friction", friction),
            tangential_restitution=number("tangential_restitution", tangential_restitution),
            rolling_friction=number("rolling_friction", rolling_friction),
            category=unsigned("category", category, 1, 32),
            collides_with=unsigned("collides_with", collides_with, 1, 32),
            group=unsigned("group", group, 1, 32),
            sensor=flags("sensor", sensor, 1),
            self_contacts=flags("self_contacts", self_contacts, 1),
            user_data=unsigned("user_data", user_data, 1, 64),
        )
        return int(added[0])

    def add_bodies(
        self,
        shapes: Shape | Sequence[Shape] | None,
        positions: ArrayLike,
        velocities: ArrayLike = STILL,
        accelerations: ArrayLike = STILL,
        *,
        radii: ArrayLike | None = None,
        orientations: ArrayLike = UPRIGHT,
        angular_velocities: ArrayLike = STILL,
        higher: ArrayLike = NOTHING,
        starts: ArrayLike | None = None,
        then: Motion | Sequence[Motion] = (),
        masses: ArrayLike = 1.0,
        inertias: ArrayLike = 0.0,
        fixed: ArrayLike = False,
        restitutions: ArrayLike = 1.0,
        frictions: ArrayLike = 0.0,
        tangential_restitutions: ArrayLike = 0.0,
        rolling_frictions: ArrayLike = 0.0,
        categories: ArrayLike = 1,
        collide_with: ArrayLike = 0xFFFFFFFF,
        groups: ArrayLike = 0,
        sensors: ArrayLike = False,
        self_contacts: ArrayLike = False,
        user_data: ArrayLike = 0,
    ) -> Ids:
        """Adds n bodies; returns their ids (n,), of uint64.

        shapes: one for all, or n; or None with `radii`, a number or (n,): balls. positions (n, 3). Of all others either
        (n, 3), orientations (n, 4), higher (n, k, 3), numbers (n,), or one for all. What they mean, add_body() says;
        inertias are moments, 0 for that of the shape. `then`: m further pieces for each, a Motion with `start` (n, m)
        and positions (n, m, 3), ...; with `start` (m,), or as several Motions, they count for all.

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
            several = list(shapes) if isinstance(shapes, Iterable) else []
            if len(several) != n or not all(isinstance(shape, Shape) for shape in several):
                raise ValueError(f"shapes: must be a kds.Shape or {n} of them, as many as positions")
        motions = np.empty((n, COLUMNS))
        motions[:, POSITION] = where
        motions[:, VELOCITY] = rows("velocities", velocities, n, 3)
        motions[:, ACCELERATION] = rows("accelerations", accelerations, n, 3)
        motions[:, TIME] = self._core.now() if starts is None else column("starts", starts, n)
        motions[:, ORIENTATION] = rows("orientations", orientations, n, 4)
        motions[:, ANGULAR_VELOCITY] = rows("angular_velocities", angular_velocities, n, 3)
        motions[:, HIGHER] = higher_terms("higher", higher, (n,))
        return self._add(
            several,
            None if radii is None else column("radii", radii, n),
            motions,
            scripts("then", then, motions[:, TIME]),
            mass=column("masses", masses, n),
            inertia=column("inertias", inertias, n),
            tensor=None,
            fixed=flags("fixed", fixed, n),
            restitution=column("restitutions", restitutions, n),
            friction=column("frictions", frictions, n),
            tangential_restitution=column("tangential_restitutions", tangential_restitutions, n),
            rolling_friction=column("rolling_frictions", rolling_frictions, n),
            category=unsigned("categories", categories, n, 32),
            collides_with=unsigned("collide_with", collide_with, n, 32),
            group=unsigned("groups", groups, n, 32),
            sensor=flags("sensors", sensors, n),
            self_contacts=flags("self_contacts", self_contacts, n),
            user_data=unsigned("user_data", user_data, n, 64),
        )

    def _add(
        self,
        shapes: list[Shape],
        radii: Doubles | None,
        motions: Doubles,
        later: Doubles,
        *,
        mass: Any,
        inertia: Any,
        tensor: Any,
        fixed: Any,
        restitution: Any,
        friction: Any,
        tangential_restitution: Any,
        rolling_friction: Any,
        category: Any,
        collides_with: Any,
        group: Any,
        sensor: Any,
        self_contacts: Any,
        user_data: Any,
    ) -> Ids:
        n = len(motions)
        numbers = np.empty((n, 6))
        surfaces = (restitution, friction, tangential_restitution, rolling_friction)
        for place, value in enumerate((mass, inertia, *surfaces)):
            numbers[:, place] = value
        both = np.stack([category, collides_with, group], axis=1)
        bits = fixed + np.uint8(2) * sensor + np.uint8(4) * self_contacts
        if n == 0:
            return np.empty(0, np.uint64)
        return self._core.add(shapes, radii, motions, numbers, both, bits, user_data, tensor, later)

    def __len__(self) -> int:
        return self._core.size()

    def __contains__(self, body: object) -> bool:
        if not isinstance(body, (int, np.integer)) or not 0 <= body < 2**64:
            return False
        return self._core.contains(int(body))

    @property
    def bodies(self) -> Ids:
        """The ids of all bodies (n,)."""
        raise NotImplementedError

    def _motions(self, bodies: ArrayLike | None) -> Doubles:
        return self._core.motions_now(self.bodies if bodies is None else ids("bodies", bodies), False)

    def positions(self, bodies: ArrayLike | None = None) -> Doubles:
        """Where the centres are now (n, 3): of these bodies, or of all, as `bodies` has them. Of one that is to enter
        later: where it will."""
        return self._motions(bodies)[:, POSITION].copy()

    def velocities(self, bodies: ArrayLike | None = None) -> Doubles:
        """Their velocities (n, 3)."""
        return self._motions(bodies)[:, VELOCITY].copy()

    def accelerations(self, bodies: ArrayLike | None = None) -> Doubles:
        """Their accelerations (n, 3), those by resting contacts included."""
        return self._motions(bodies)[:, ACCELERATION].copy()

    def higher(self, bodies: ArrayLike | None = None) -> Doubles:
        """The coefficients of (t - now)^3, ^4 and ^5 of their paths (n, 3, 3), which are 0 beyond the degree of the
        world."""
        return self._motions(bodies)[:, HIGHER].reshape(-1, 3, 3).copy()

    def position(self, body: int) -> Doubles:
        """Where the centre of one body is now (3,)."""
        return self.positions([identity("body", body)])[0]

    def velocity(self, body: int) -> Doubles:
        """Its velocity (3,)."""
        return self.velocities([identity("body", body)])[0]


class Bodies(MovingBodies):
    """What bodies are in a World."""

    _core: _kds.World

    @property
    def bodies(self) -> Ids:
        """The ids of all bodies (n,), those that enter later included."""
        return self._core.bodies()

    def attach_sensor(
        self,
        body: int,
        shape: Shape,
        *,
        category: int = 1,
        collides_with: int = 0xFFFFFFFF,
        group: int = 0,
        user_data: int = 0,
    ) -> int:
        """Adds a sensor that moves with a body, whatever changes the motion of that, and is removed with it; returns
        its id. It never meets that body, nor other sensors of it. ValueError if that is attached itself."""
        masks = (("category", category), ("collides_with", collides_with), ("group", group))
        return self._core.attach(
            shape_of("shape", shape),
            identity("body", body),
            np.stack([unsigned(name, value, 1, 32) for name, value in masks], axis=1),
            int(unsigned("user_data", user_data, 1, 64)[0]),
        )

    def orientations(self, bodies: ArrayLike | None = None) -> Doubles:
        """Their orientations (n, 4): w, x, y, z."""
        return self._motions(bodies)[:, ORIENTATION].copy()

    def angular_velocities(self, bodies: ArrayLike | None = None) -> Doubles:
        """Their angular velocities (n, 3), rad/s; of a body that precesses that of its present piece."""
        return self._motions(bodies)[:, ANGULAR_VELOCITY].copy()

    def shape(self, body: int) -> Shape:
        """The shape that it was added with."""
        return self._core.shape(identity("body", body))

    def vertices(self, body: int) -> Doubles:
        """Where the vertices of a mesh that bends are now (n, 3), seen from the body's centre and before it is turned
        into its orientation. ValueError for other bodies."""
        return np.array(self._core.vertices(identity("body", body)), np.float64).reshape(-1, 3)

    def free_turning(self, body: int) -> FreeTurning:
        """How a body is turned now, and turns, in a world that turns; of one that precesses exact up to roundings, where
        angular_velocities() has that of its present piece. ValueError for a body whose turning no contact changes (one
        that is fixed, or a sensor), and in other worlds."""
        return FreeTurning(*self._core.free_turning(identity("body", body)))

    def mass(self, body: int) -> float:
        """Its mass; of a fixed body too, which no contact moves."""
        return self._core.mass(identity("body", body))

    def fixed(self, body: int) -> bool:
        """Whether no other body changes its motion."""
        return self._core.fixed(identity("body", body))

    def sensor(self, body: int) -> bool:
        """Whether it only reports."""
        return self._core.sensor(identity("body", body))

    def attached_to(self, body: int) -> int | None:
        """The body that a sensor moves with; None if it is not attached."""
        return self._core.attached_to(identity("body", body))

    def restitution(self, body: int) -> float:
        """Its restitution: of two that meet the lower counts."""
        return self._core.restitution(identity("body", body))

    def category(self, body: int) -> int:
        """The bits that say what it is."""
        return int(self._core.masks(np.array([identity("body", body)], np.uint64))[0, 0])

    def collides_with(self, body: int) -> int:
        """The bits that say with what it may collide."""
        return int(self._core.masks(np.array([identity("body", body)], np.uint64))[0, 1])

    def group(self, body: int) -> int:
        """The number of its group, 0 if it has none."""
        return int(self._core.masks(np.array([identity("body", body)], np.uint64))[0, 2])

    def user_data(self, body: int) -> int:
        """Your own number for it, 0 if none was given."""
        return self._core.user_data(identity("body", body))


def _whole_motion(name: str, motion: Motion) -> tuple[Doubles, Doubles]:
    """The first piece of a motion, and those after it."""
    table = pieces(name, motion, -math.inf)
    if len(table) == 0:
        raise ValueError(f"{name}: has no pieces")
    return table[:1], table[1:]
