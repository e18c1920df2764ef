"""Motions as they are given, and as rows that go to C++."""

from __future__ import annotations

from typing import Any, NamedTuple, Sequence

import numpy as np
from numpy.typing import ArrayLike

from kds._arrays import Doubles, array_of, doubles, number

STILL = (0.0, 0.0, 0.0)
UPRIGHT = (1.0, 0.0, 0.0, 0.0)
NOTHING = ()  #: no higher terms

# Columns of the rows in which motions go to and from C++.
POSITION, VELOCITY, ACCELERATION = slice(0, 3), slice(3, 6), slice(6, 9)
TIME, ORIENTATION, ANGULAR_VELOCITY = 9, slice(10, 14), slice(14, 17)
HIGHER = slice(17, 26)
COLUMNS = 26


class Motion(NamedTuple):
    """A piece of a motion, from `start` (s) on. Velocities and accelerations are not halved.

    Or n pieces, where `start` is an array (n,): then the others are (n, 3), orientations (n, 4), higher (n, k, 3), or
    one for all.
    """

    start: float | ArrayLike
    position: ArrayLike
    velocity: ArrayLike = STILL
    acceleration: ArrayLike = STILL
    orientation: ArrayLike = UPRIGHT  #: of worlds that turn, and of the first piece of a body
    angular_velocity: ArrayLike = STILL  #: rad/s, in the axes of the world
    higher: ArrayLike = NOTHING  #: (k, 3): coefficients of (t - start)^3 and so on, up to ^5; in worlds of that degree

    @classmethod
    def through(
        cls,
        times: ArrayLike,
        positions: ArrayLike,
        velocities: ArrayLike,
        accelerations: ArrayLike | None = None,
    ) -> Motion:
        """The pieces through n way points, at least two: times (n,), which ascend, positions and velocities (n, 3).

        From each to the next it is the one cubic that has these positions and velocities at both ends (Hermite's), for
        worlds of degree 3; with accelerations (n, 3) the one quintic, for degree 5. After the last it goes on with the
        velocity and the acceleration there. By rounding a piece misses its end by up to 2^-48 (quintics 2^-45) of the
        numbers that it is made of, as those of certificates/point_motion.hpp.
        """
        t = doubles("times", times, (None,))
        if len(t) < 2 or not np.isfinite(t).all() or not (np.diff(t) > 0).all():
            raise ValueError("times: must be at least two, finite, and ascend")
        x = doubles("positions", positions, (len(t), 3))
        v = doubles("velocities", velocities, (len(t), 3))
        a = np.zeros_like(x) if accelerations is None else doubles("accelerations", accelerations, (len(t), 3))
        duration = np.diff(t)[:, None]
        higher = np.zeros((len(t), 1 if accelerations is None else 3, 3))
        if accelerations is None:
            way, w0, w1 = x[1:] - x[:-1], v[:-1] * duration, v[1:] * duration
            a[:-1] = 2 * ((3 * way - (2 * w0 + w1)) / duration / duration)
            higher[:-1, 0] = ((w0 + w1) - 2 * way) / duration / duration / duration
        else:
            # Position, velocity and acceleration at the end minus those of the parabola through the beginning.
            bend = a[:-1] * duration * duration
            way = x[1:] - x[:-1] - v[:-1] * duration - 0.5 * bend
            rate = (v[1:] - v[:-1]) * duration - bend
            turn = a[1:] * duration * duration - bend
            terms = 10 * way - 4 * rate + 0.5 * turn, 7 * rate - 15 * way - turn, 6 * way - 3 * rate + 0.5 * turn
            for power, term in enumerate(terms, 3):
                for _ in range(power):
                    term = term / duration
                higher[:-1, power - 3] = term
        return cls(t, x, v, a, higher=higher)


MEMBERS = (
    ("position", POSITION),
    ("velocity", VELOCITY),
    ("acceleration", ACCELERATION),
    ("orientation", ORIENTATION),
    ("angular_velocity", ANGULAR_VELOCITY),
)


def higher_terms(name: str, value: ArrayLike, shape: tuple[int, ...], every: bool = True) -> Doubles:
    """Coefficients (..., k, 3) of (t - start)^3 and on as columns: shape + (9,). What stands for `...` is `shape`, or
    its end: then it counts for all (unless `every` is False)."""
    array = array_of(name, value)
    if array.size == 0:
        return np.zeros(shape + (9,))
    k = array.shape[-2] if array.ndim >= 2 else 0
    if array.dtype.kind not in "iuf":
        raise ValueError(f"{name}: must be real numbers, and has the dtype {array.dtype}")
    given = array.shape[:-2]
    fits = given == shape or (every and len(given) < len(shape) and given == shape[len(shape) - len(given) :])
    if not (1 <= k <= 3 and array.shape[-1] == 3 and fits):
        rest = "".join(f"{size}, " for size in shape)
        raise ValueError(f"{name}: must have the shape ({rest}k, 3), k from 1 to 3, and has {array.shape}")
    columns = np.zeros(shape + (3, 3))
    columns[..., :k, :] = array
    return columns.reshape(shape + (9,))


def _columns(name: str, value: ArrayLike, shape: tuple[int, ...], width: int) -> Doubles:
    """Doubles (..., width), where `shape`, or its end, stands for `...`."""
    array = array_of(name, value)
    given = array.shape[:-1]
    if array.dtype.kind in "iuf" and array.ndim > 0 and array.shape[-1] == width and len(given) < len(shape):
        if given == shape[len(shape) - len(given) :]:
            return np.broadcast_to(np.asarray(array, dtype=np.float64), shape + (width,))
    return doubles(name, value, shape + (width,))


def _fill(table: Doubles, name: str, motion: Motion) -> None:
    shape = table.shape[:-1]
    for member, columns in MEMBERS:
        width = columns.stop - columns.start
        table[..., columns] = _columns(f"{name}.{member}", getattr(motion, member), shape, width)
    table[..., HIGHER] = higher_terms(f"{name}.higher", motion.higher, shape)


def table_of(name: str, given: Motion | Sequence[Motion]) -> Doubles:
    """Rows of pieces (n, COLUMNS)."""
    if isinstance(given, Motion) and array_of(f"{name}.start", given.start).ndim > 0:
        starts = doubles(f"{name}.start", given.start, (None,))
        table = np.empty((len(starts), COLUMNS))
        table[:, TIME] = starts
        _fill(table, name, given)
        return table
    if not isinstance(given, Motion):
        return _one_by_one(name, given)
    return _one_by_one(name, [given])


def pieces(name: str, given: Motion | Sequence[Motion], after: float) -> Doubles:
    """Rows of pieces, each of which starts later than the one before, and the first later than `after` (s)."""
    table = table_of(name, given)
    _require_order(name, table[None], np.array([after]))
    return table


def scripts(name: str, given: Motion | Sequence[Motion], after: Doubles) -> Doubles:
    """Rows of pieces (n * k, COLUMNS), k for each of n bodies: `start` (n, k), or (k,) for all, and the others in
    that shape; or pieces that count for all bodies."""
    n = len(after)
    if n == 1 and (not isinstance(given, Motion) or array_of(f"{name}.start", given.start).ndim < 2):
        return pieces(name, given, after[0])
    if isinstance(given, Motion) and array_of(f"{name}.start", given.start).ndim > 0:
        starts = array_of(f"{name}.start", given.start)
        starts = doubles(f"{name}.start", given.start, (None,) if starts.ndim == 1 else (n, None))
        table = np.empty((n, starts.shape[-1], COLUMNS))
        table[..., TIME] = starts
        _fill(table, name, given)
    else:
        one = table_of(name, given)
        table = np.broadcast_to(one, (n,) + one.shape)
    _require_order(name, table, after)
    return table.reshape(-1, COLUMNS)


def _require_order(name: str, table: Doubles, after: Doubles) -> None:
    if table.shape[1] == 0:
        return
    starts = table[..., TIME]
    before = np.concatenate([after[:, None], starts[:, :-1]], axis=1)
    wrong = np.argwhere(~(starts > before))
    if len(wrong):
        body, i = (int(place) for place in wrong[0])
        where = f"{name}[{i}]" if len(table) == 1 else f"{name}[{body}, {i}]"
        raise ValueError(f"{where}.start: must be later than {before[body, i]}, and is {starts[body, i]}")


def _one_by_one(name: str, given: Any) -> Doubles:
    try:
        several = list(given)
    except TypeError:
        raise ValueError(f"{name}: must be a kds.Motion or a sequence of them, and is {given!r}") from None
    table = np.empty((len(several), COLUMNS))
    for i, piece in enumerate(several):
        if not isinstance(piece, Motion):
            raise ValueError(f"{name}[{i}]: must be a kds.Motion, and is {piece!r}")
        table[i, TIME] = number(f"{name}[{i}].start", piece.start)
        _fill(table[i], f"{name}[{i}]", piece)
    return table
