"""Events as rows of a structured array."""

from __future__ import annotations

from enum import IntEnum
from typing import Any

import numpy as np

from kds import _kds

#: time (s), kind (EventKind), a and b (ids of bodies; b of an event at a wall is the wall: 0 is -x, 1 is +x, ... 5 is
#: +z; of an event of one thing, a piece or a timer, the same as a), point (3,), normal (3,) from a to b, feature_a and
#: feature_b (see feature_name), user_data_a and user_data_b (of the bodies, also of those that have been removed; 0 of
#: walls, timers, PAIR_BEGIN and PAIR_END, and in the events of Scene.run).
event_dtype: np.dtype = np.dtype((np.record, _kds.event_dtype))


class EventKind(IntEnum):
    """The kinds of events. Those of rest and of walls have the same names in the tool's CSV files."""

    CONTACT = 0  #: penetration begins
    SEPARATION = 1  #: and ends: of bodies that pass through each other
    OVERLAP = 2  #: in contact when one of the two enters
    WALL = 3  #: a body reaches a wall
    PAIR_BEGIN = 4  #: bounding volumes begin to overlap: with report_pairs
    PAIR_END = 5
    REST = 6  #: two bodies begin to rest on each other
    WAKE = 7  #: and cease to
    REST_AT_WALL = 8
    WAKE_AT_WALL = 9
    PASS = 10  #: two bodies are let through each other
    PIECE = 11  #: a piece of a body's motion starts: with report_pieces
    TIMER = 12  #: of World.set_timer; a is its number
    WRAP = 13  #: of a PeriodicWorld: a body comes in at the other side


def kind_of(name: str, value: Any) -> int:
    try:
        return int(EventKind(value))
    except ValueError:
        raise ValueError(f"{name}: must be a kds.EventKind, and is {value!r}") from None


def as_events(rows: np.ndarray) -> np.recarray:
    """Rows with names for columns: events.time as well as events["time"]."""
    return rows.view(event_dtype).view(np.recarray)


#: Of a PeriodicWorld: the same, with offset (3,) and impulse. `offset` says which copy of b the body a meets: the one that
#: many periods away; of WRAP, by how many periods the body was moved back. `impulse` (mass * length/s) was given to b
#: along the normal, and to a against it.
periodic_event_dtype: np.dtype = np.dtype(
    (np.record, np.dtype(_kds.event_dtype.descr + [("offset", np.int64, (3,)), ("impulse", np.float64)]))
)


def as_periodic_events(rows: np.ndarray) -> np.recarray:
    return rows.view(periodic_event_dtype).view(np.recarray)


def feature_name(feature: Any) -> str:
    """The vertex, edge or face of a feature_a or feature_b, as the tool writes it: 'v12', 'e3-17', 'f40', or '-'."""
    kind = int(feature["kind"])
    if kind == 2:
        return f"e{feature['first']}-{feature['second']}"
    return "-" if kind == 0 else f"{'v' if kind == 1 else 'f'}{feature['first']}"
