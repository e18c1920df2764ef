"""What changes in a world: motions, masses, filters; bodies that leave."""

from __future__ import annotations

from typing import Any, Sequence

import numpy as np
from numpy.typing import ArrayLike

from kds import _kds
from kds._arrays import Doubles, Ids, column, doubles, identity, ids, keyframes, one_or_more, rows, unsigned, vector
from kds._motion import (
    ACCELERATION,
    ANGULAR_VELOCITY,
    COLUMNS,
    HIGHER,
    ORIENTATION,
    POSITION,
    TIME,
    VELOCITY,
    Motion,
    higher_terms,
    pieces,
    scripts,
)


class MotionEdits:
    """How the bodies of a world of any kind are changed."""

    _core: Any
    _turning: bool

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
        higher: ArrayLike | None = None,
        then: Motion | Sequence[Motion] = (),
    ) -> None:
        """Gives a body a new motion from now on; what is left out stays as it is now. Pieces to come are discarded, and
        those of `then` come in their place, each later than the one before."""
        one = {
            "positions": None if position is None else vector("position", position),
            "velocities": None if velocity is None else vector("velocity", velocity),
            "accelerations": None if acceleration is None else vector("acceleration", acceleration),
            "orientations": None if orientation is None else doubles("orientation", orientation, (4,)),
            "angular_velocities": None if angular_velocity is None else vector("angular_velocity", angular_velocity),
            "higher": None if higher is None else higher_terms("higher", higher, ()).reshape(1, 3, 3),
        }
        self._update(np.array([identity("body", body)], np.uint64), then, **one)

    def update_motions(
        self,
        bodies: ArrayLike,
        *,
        positions: ArrayLike | None = None,
        velocities: ArrayLike | None = None,
        accelerations: ArrayLike | None = None,
        orientations: ArrayLike | None = None,
        angular_velocities: ArrayLike | None = None,
        higher: ArrayLike | None = None,
        then: Motion | Sequence[Motion] = (),
    ) -> None:
        """The same for n bodies, all or, if one is wrong, none: ids (n,), and (n, 3) or (3,), orientations (n, 4),
        higher (n, k, 3) or (k, 3); `then` as add_bodies() has it."""
        self._update(
            ids("bodies", bodies),
            then,
            positions=positions,
            velocities=velocities,
            accelerations=accelerations,
            orientations=orientations,
            angular_velocities=angular_velocities,
            higher=higher,
        )

    def _update(
        self,
        which: Ids,
        then: Motion | Sequence[Motion],
        *,
        positions: ArrayLike | None,
        velocities: ArrayLike | None,
        accelerations: ArrayLike | None,
        orientations: ArrayLike | None,
        angular_velocities: ArrayLike | None,
        higher: ArrayLike | None,
    ) -> None:
        """The motions of now, with what is given in their place, and then those."""
        if orientations is not None and not self._turning:
            raise ValueError("orientation: bodies keep theirs in a world that is not turning")
        motions = self._core.motions_now(which, True)
        motions[:, TIME] = self._core.now()
        given = (
            ("positions", positions, POSITION),
            ("velocities", velocities, VELOCITY),
            ("accelerations", accelerations, ACCELERATION),
            ("orientations", orientations, ORIENTATION),
            ("angular_velocities", angular_velocities, ANGULAR_VELOCITY),
        )
        for name, value, columns in given:
            if value is not None:
                motions[:, columns] = rows(name, value, len(which), columns.stop - columns.start)
        if higher is not None:
            motions[:, HIGHER] = higher_terms("higher", higher, (len(which),))
        later = scripts("then", then, motions[:, TIME])
        if len(later):
            motions = np.concatenate([motions[:, None], later.reshape(len(which), -1, COLUMNS)], axis=1)
        self._core.update(which, motions.reshape(-1, COLUMNS))

    def set_restitution(self, bodies: ArrayLike, restitution: ArrayLike) -> None:
        """Gives bodies other restitutions, from 0 to 1: an id, or ids (n,), and a number for all or (n,). They count from
        the next contact on; all change, or none."""
        which = one_or_more("bodies", bodies)
        self._core.set_restitutions(which, column("restitution", restitution, len(which)))


class Edits(MotionEdits):
    """How the bodies of a World are changed."""

    _core: _kds.World

    def append_motion(self, body: int, motion: Motion | Sequence[Motion]) -> None:
        """Adds pieces of motion after those that are still to come, each later than the one before: so a stream of
        pieces needs no more than the next ones. All are added, or none."""
        self._core.append(identity("body", body), pieces("motion", motion, self._core.now()))

    def update_vertices(self, body: int, times: ArrayLike = (), positions: ArrayLike = ()) -> None:
        """Replaces what is still to come of the vertices of a mesh that bends: from where they are now they move on
        straight lines to the positions (k, n, 3) at the times (k,), each later than now (s) and than the one before,
        and stand still after the last; with none, from now on. One time may be a number, its positions (n, 3).

        So a simulator of cloth gives the end of each of its steps. Nothing jumps; the motion of the body goes on.
        Pictures of a world that records show the vertices that a body is first seen with.
        """
        which = identity("body", body)
        when, where = keyframes(times, positions)
        self._core.update_vertices(which, when, where)

    def set_mass(self, bodies: ArrayLike, mass: ArrayLike) -> None:
        """Gives bodies other masses: an id, or ids (n,), and a number for all or (n,); inertias change by the same
        factors, and motions do not change. ValueError for bodies that are fixed. All change, or none."""
        which = one_or_more("bodies", bodies)
        self._core.set_masses(which, column("mass", mass, len(which)))

    def set_filter(
        self,
        bodies: ArrayLike,
        category: ArrayLike | None = None,
        collides_with: ArrayLike | None = None,
        group: ArrayLike | None = None,
    ) -> None:
        """The same for what bodies are and may collide with (add_body()); what is left out stays as it is.

        Contacts with bodies that they may not collide with any more end: as separations of bodies that pass through
        each other, and what rests on them wakes. Where they are in contact with bodies with which they could not
        collide before, that is an overlap.
        """
        which = one_or_more("bodies", bodies)
        both = self._core.masks(which)
        named = (("category", category), ("collides_with", collides_with), ("group", group))
        for place, (name, value) in enumerate(named):
            if value is not None:
                both[:, place] = unsigned(name, value, len(which), 32)
        self._core.set_filters(which, both)

    def ignore_pair(self, a: int, b: int, ignored: bool = True) -> None:
        """Two bodies do not collide with each other from now on, whatever their filters, or do again; what they are
        doing now ends and begins as set_filter() says."""
        self._core.ignore_pair(identity("a", a), identity("b", b), bool(ignored))

    def ignores_pair(self, a: int, b: int) -> bool:
        """Whether two bodies are ignored as a pair."""
        return self._core.ignores_pair(identity("a", a), identity("b", b))

    def set_user_data(self, bodies: ArrayLike, user_data: ArrayLike) -> None:
        """The same for numbers of your own, of 64 bits, which later events carry."""
        which = one_or_more("bodies", bodies)
        self._core.set_user_data(which, unsigned("user_data", user_data, len(which), 64))
