"""Scene files, read and run as the tool kds-collide does (docs/kds-collide.md)."""

from __future__ import annotations

import json
import os
import warnings
from typing import Any, NamedTuple

import numpy as np

from kds import _kds
from kds._arrays import flag, number, path, whole, word
from kds._events import as_events
from kds._world import World


class Run(NamedTuple):
    """What Scene.run gives back."""

    events: np.recarray  #: of event_dtype; a and b are places in Scene.names
    stats: dict[str, Any]  #: as the tool's --stats


class Scene:
    """A scene file, checked; made by Scene.read or Scene.parse."""

    def __init__(self, core: Any, title: str) -> None:
        self._core = core
        self._title = title

    @classmethod
    def read(cls, file: str | os.PathLike[str], until: float | None = None) -> Scene:
        """Reads a scene and the meshes that it names; it ends at `until` (s) in place of its own end_time.

        ValueError says what is wrong where: `scene.json: bodies[3].shape.sphere.radius: must be > 0`.
        """
        name = path("file", file)
        return cls._warned(_kds.read_scene(name, None if until is None else number("until", until)), name)

    @classmethod
    def parse(cls, text: str, file: str | os.PathLike[str] = "scene.json", until: float | None = None) -> Scene:
        """The same from text; `file` is named in errors, and meshes are looked for beside it."""
        name = path("file", file)
        end = None if until is None else number("until", until)
        return cls._warned(_kds.parse_scene(word("text", text), name, end), name)

    @classmethod
    def _warned(cls, core: Any, name: str) -> Scene:
        """Of a scene in which something was mended, Python's warnings say what."""
        for warning in core.warnings:
            warnings.warn(warning, stacklevel=3)
        return cls(core, os.path.basename(name))

    @property
    def names(self) -> list[str]:
        """Of the bodies, in the order of the file."""
        return self._core.names

    @property
    def begin_time(self) -> float:
        return self._core.begin_time

    @property
    def end_time(self) -> float:
        return self._core.end_time

    @property
    def degree(self) -> int:
        """2 where a body accelerates, else 1."""
        return self._core.degree

    @property
    def turning(self) -> bool:
        return self._core.turning

    def __len__(self) -> int:
        return len(self.names)

    def __repr__(self) -> str:
        return f"<kds.Scene {self._title}: {len(self)} bodies, {self.begin_time} to {self.end_time} s>"

    def run(
        self,
        *,
        broad_phase: str = "auto",
        rate: float = 0.0,
        kdop: int = 6,
        pairs: bool = False,
        threads: int = 1,
        domains: int = 1,
        shortest_flight: float = 1e-3,
        orientation_error: float = 1e-3,
        gather: bool = True,
        profile: bool = False,
        csv: str | os.PathLike[str] | None = None,
        replay: str | os.PathLike[str] | None = None,
    ) -> Run:
        """Runs the scene from its beginning to its end; it may be run any number of times.

        `csv`, `replay`: files to write, which are those of the tool's --events and --view to the byte; they appear when
        the run has ended. gather=False: no array of events. profile=True: stats["profile"] has the CPU time of each kind
        of work, as World.profile. The other arguments are the tool's; with more `domains` than
        1, or 0 for as many as are best, the threads run parts of the scene (docs/parallel.md), the events are the same,
        and there are no pairs and no replay. Other threads go on meanwhile. OSError for files that cannot be written;
        RuntimeError where a replay wants three.js, which is not there.
        """
        if domains != 1 and (pairs or profile or replay is not None):
            what = "pairs are told of" if pairs else "work is profiled" if profile else "there is a replay"
            raise ValueError(f"domains: must be 1 where {what}")
        rows, stats, work = self._core.run(
            word("broad_phase", broad_phase),
            number("rate", rate),
            whole("kdop", kdop, 2**31 - 1),
            flag("pairs", pairs),
            whole("threads", threads),
            whole("domains", domains, 65535),
            number("shortest_flight", shortest_flight),
            number("orientation_error", orientation_error),
            flag("gather", gather),
            flag("profile", profile),
            "" if csv is None else path("csv", csv),
            "" if replay is None else path("replay", replay),
            self._title,
        )
        counted = json.loads(stats)
        if profile:
            counted["profile"] = work
        return Run(as_events(rows), counted)

    def world(self, *, gather: bool = True, broad_phase: str = "auto", record: bool = False) -> World:
        """A world with the bodies of the scene, at its begin_time: to be run step by step, asked and changed. `record`:
        whether it is to write_replay().

        Ids of bodies are their places in `names`. Such a world has snapshots, but cannot be pickled.
        """
        core = self._core.world(flag("gather", gather), word("broad_phase", broad_phase), flag("record", record))
        return World._of_core(core, self.degree, self.turning)


def generate_scene(
    file: str | os.PathLike[str],
    kind: str = "rings",
    bodies: int = 1000,
    density: float | None = None,
    seed: int = 1,
    end_time: float | None = None,
) -> Scene:
    """Writes a scene of the tool's generator, with its meshes beside it, and reads it.

    `kind`: 'rings', 'spheres', 'boxes', 'models', 'spinners', ... (`kds-collide --help` names all). `density`: the
    volume of all bounding balls over that of the domain, 0.01 unless given; not for 'sheet' and 'crates'. `end_time`:
    1 s unless given, of crates 8 s.
    """
    name = path("file", file)
    _kds.generate_scene(
        name,
        word("kind", kind),
        whole("bodies", bodies),
        None if density is None else number("density", density),
        whole("seed", seed),
        None if end_time is None else number("end_time", end_time),
    )
    return Scene.read(name)
