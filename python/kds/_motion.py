"""Motions as they are given, and as rows that go to C++."""

from __future__ import annotations

from typing import Any, NamedTuple, Sequence

import numpy as np
from numpy.typing import ArrayLike

from kds._arrays import Doubles, array_of, doubles, number, rows

STILL = (0.0, 0.0, 0.0)
UPRIGHT = (1.0, 0.0, 0.0, 0.0)

# Columns of the rows in which motions go to and from C++.
POSITION, VELOCITY, ACCELERATION = slice(0, 3), slice(3, 6), slice(6, 9)
TIME, ORIENTATION, ANGULAR_VELOCITY = 9, slice(10, 14), slice(14, 17)
COLUMNS = 17


class Motion(NamedTuple):
    """A piece of a motion, from `start` (s) on. Velocities and accelerations are not halved.

    Or n pieces, where `start` is an array (n,): then the others are (n, 3), orientations (n, 4), or one for all.
    """

    start: float | ArrayLike
    position: ArrayLike
    velocity: ArrayLike = STILL
    acceleration: ArrayLike = STILL
    orientation: ArrayLike = UPRIGHT  #: of worlds that turn
    angular_velocity: ArrayLike = STILL  #: rad/s, in the axes of the world


def pieces(name: str, given: Motion | Sequence[Motion], after: float) -> Doubles:
    """Rows of pieces, each of which starts later than the one before, and the first later than `after` (s)."""
    if isinstance(given, Motion) and array_of(f"{name}.start", given.start).ndim > 0:
        starts = doubles(f"{name}.start", given.start, (None,))
        table = np.empty((len(starts), COLUMNS))
        table[:, TIME] = starts
        _fill(table, name, given)
    else:
        table = _one_by_one(name, [given] if isinstance(given, Motion) else given)
    before = np.concatenate([[after], table[:-1, TIME]]) if len(table) else np.empty(0)
    wrong = np.flatnonzero(~(table[:, TIME] > before))
    if len(wrong):
        i = int(wrong[0])
        raise ValueError(f"{name}[{i}].start: must be later than {before[i]}, and is {table[i, TIME]}")
    return table


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
        _fill(table[i : i + 1], f"{name}[{i}]", piece, one=True)
    return table


def _fill(table: Doubles, name: str, motion: Motion, one: bool = False) -> None:
    for member, columns in (
        ("position", POSITION),
        ("velocity", VELOCITY),
        ("acceleration", ACCELERATION),
        ("orientation", ORIENTATION),
        ("angular_velocity", ANGULAR_VELOCITY),
    ):
        width, value = columns.stop - columns.start, getattr(motion, member)
        where = f"{name}.{member}"
        table[:, columns] = doubles(where, value, (width,)) if one else rows(where, value, len(table), width)
