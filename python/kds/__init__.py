"""Collisions of moving bodies at exact times, and kinetic data structures.

    import kds
    world = kds.World(response="elastic")
    world.add_body(kds.sphere(1.0), position=(0, 0, 0), velocity=(1, 0, 0))
    world.add_body(kds.sphere(1.0), position=(4, 0, 0), velocity=(-1, 0, 0))
    for event in world.advance_to(10):
        print(event.time, event.kind, event.a, event.b)

Lengths and masses are in units of your choice, times in seconds, angles in radians; vectors are of three numbers,
orientations unit quaternions w, x, y, z. What is wrong with an argument is said by ValueError; RuntimeError means that
a call is not possible now. The guide is docs/python.md.
"""

from kds._bodies import FreeTurning
from kds._events import EventKind, event_dtype, feature_name, periodic_event_dtype
from kds._kds import Shape, version as __version__
from kds._motion import Motion
from kds._periodic import PeriodicWorld
from kds._queries import Approach, Distance, shape_distance
from kds._scene import Run, Scene, generate_scene
from kds._shapes import bending_mesh, box, capsule, compound, half_space, heightfield, hull, mesh, read_mesh, sphere
from kds._structures import ConvexHull, Delaunay, SortedList
from kds._world import World

__all__ = [
    "Approach",
    "ConvexHull",
    "Delaunay",
    "Distance",
    "EventKind",
    "FreeTurning",
    "Motion",
    "PeriodicWorld",
    "Run",
    "Scene",
    "Shape",
    "SortedList",
    "World",
    "bending_mesh",
    "box",
    "capsule",
    "compound",
    "event_dtype",
    "feature_name",
    "generate_scene",
    "half_space",
    "heightfield",
    "hull",
    "mesh",
    "periodic_event_dtype",
    "read_mesh",
    "shape_distance",
    "sphere",
]
