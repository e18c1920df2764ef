"""Kinetic structures: a sorted list, a convex hull and a Delaunay triangulation of things that move.

They know their state at all times: `advance_to` processes the events in between, at exact times. Degrees are 1 and 2:
coefficients are given lowest first, and that of t^2 is *half* the acceleration. Elements have numbers, 0, 1, 2, ...
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kds import _kds
from kds._arrays import Doubles, array_of, finite, number, whole


def _padded(name: str, value: ArrayLike, tail: tuple[int, ...]) -> Doubles:
    """(n, k, *tail) coefficients, k from 1 to 3, with zeros up to 3; finite."""
    array = array_of(name, value)
    shape = ", ".join(["n", "k", *map(str, tail)])
    if array.dtype.kind not in "iuf":
        raise ValueError(f"{name}: must be real numbers, and has the dtype {array.dtype}")
    if array.ndim != 2 + len(tail) or array.shape[2:] != tail or not 1 <= array.shape[1] <= 3:
        raise ValueError(f"{name}: must have the shape ({shape}), k from 1 to 3, and has {array.shape}")
    padded = np.zeros((len(array), 3, *tail))
    padded[:, : array.shape[1]] = array
    if not np.isfinite(padded).all():
        first = int(np.argwhere(~np.isfinite(padded))[0][0])
        raise ValueError(f"{name}[{first}]: must be finite")
    return padded


class _Structure:
    _tail: tuple[int, ...]
    _core: Any

    @property
    def now(self) -> float:
        """The clock, s."""
        return self._core.now()

    @property
    def next_time(self) -> float:
        """The time of the next event, s; inf if none will come."""
        return self._core.next_time()

    def __len__(self) -> int:
        return self._core.size()

    def __repr__(self) -> str:
        return f"<kds.{type(self).__name__}: {len(self)} elements at {self.now} s>"

    def _one(self, coefficients: ArrayLike) -> Doubles:
        return _padded("coefficients", array_of("coefficients", coefficients)[None], self._tail)

    def insert(self, coefficients: ArrayLike) -> int:
        """Adds an element, (k,) or (k, 2) coefficients in t - now; returns its number."""
        return self._core.insert(self._one(coefficients))

    def remove(self, element: int) -> None:
        """Takes an element out; its number is not used again by a SortedList."""
        self._core.remove(whole("element", element, 2**32 - 1))

    def update(self, element: int, coefficients: ArrayLike) -> None:
        """Gives an element a new motion from now on: coefficients in t - now. It may jump, and what that
        changes advance_to() reports, at the time of the jump."""
        self._core.update(whole("element", element, 2**32 - 1), self._one(coefficients))

    def audit(self) -> None:
        """Checks the state and every certificate by exact signs; RuntimeError if one is wrong."""
        self._core.audit()


class SortedList(_Structure):
    """Moving values, kept in ascending order.

    coefficients (n, k): of values c0 + c1 (t - start) + c2 (t - start)^2. Values that stay equal are in order of their
    numbers. Cost: of an event O(log n).
    """

    _tail = ()

    def __init__(self, coefficients: ArrayLike, start: float = 0.0) -> None:
        self._core = _kds.SortedList(_padded("coefficients", coefficients, ()), finite("start", start))

    def advance_to(self, t: float) -> np.recarray:
        """Runs to t; returns the swaps: time, left, right, in the order of time. `left` has just come before
        `right`."""
        return self._core.advance_to(number("t", t)).view(np.recarray)

    @property
    def order(self) -> NDArray[np.uint32]:
        """The elements, by ascending value (n,)."""
        return self._core.order()

    @property
    def values(self) -> Doubles:
        """The values now, in that order (n,), rounded."""
        return self._core.values()


class _PlaneStructure(_Structure):
    _tail = (2,)
    _make: Any

    def __init__(self, paths: ArrayLike, start: float = 0.0) -> None:
        self._core = type(self)._make(_padded("paths", paths, (2,)), finite("start", start))

    @property
    def ids(self) -> NDArray[np.uint32]:
        """The numbers of the points that are there (n,), ascending."""
        return self._core.ids()

    @property
    def positions(self) -> Doubles:
        """Where they are now (n, 2), rounded."""
        return self._core.positions()

    @property
    def hull(self) -> NDArray[np.uint32]:
        """The points of the convex hull, counter-clockwise from the lowest number on, those on its edges too. Empty
        while all points are on a line."""
        return self._core.hull()

    @property
    def triangles(self) -> NDArray[np.uint32]:
        """The triangles (m, 3), counter-clockwise. Of a ConvexHull they are the proof: any triangulation."""
        return self._core.triangles()

    @property
    def events(self) -> int:
        """How many certificates have failed so far."""
        return self._core.events()


class ConvexHull(_PlaneStructure):
    """The convex hull of points that move in the plane.

    paths (n, k, 2): positions c0 + c1 (t - start) + c2 (t - start)^2. Most events change only the proof.
    """

    _make = _kds.ConvexHull

    def advance_to(self, t: float) -> np.recarray:
        """Runs to t; returns what changed: time, change (+1: the point has come to the hull, -1: it has left), a (the
        point), b (the same)."""
        return self._core.advance_to(number("t", t)).view(np.recarray)


class Delaunay(_PlaneStructure):
    """The Delaunay triangulation of points that move in the plane.

    paths (n, k, 2): positions c0 + c1 (t - start) + c2 (t - start)^2. To tell which edges have changed, each flip costs
    O(n) here, which the C++ structure does not need.
    """

    _make = _kds.Delaunay

    def advance_to(self, t: float) -> np.recarray:
        """Runs to t; returns what changed: time, change (+1: an edge has come, -1: one has gone), a < b, its ends. A
        flip is two rows of one time."""
        return self._core.advance_to(number("t", t)).view(np.recarray)
