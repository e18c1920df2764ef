"""Shapes of bodies."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from kds import _kds
from kds._arrays import doubles, flag, keyframes, number, path, rows, shape_of, triangles_of, vector
from kds._kds import Shape
from kds._motion import UPRIGHT


def sphere(radius: float) -> Shape:
    """A ball about the body's centre. Radius > 0."""
    return _kds.sphere(number("radius", radius))


def box(half_extents: ArrayLike) -> Shape:
    """A solid box about the body's centre. Half extents (3,), each > 0."""
    return _kds.box(vector("half_extents", half_extents))


def capsule(radius: float, half_length: float) -> Shape:
    """All that is nearer than `radius` to the segment from -half_length to half_length on the body's z axis."""
    return _kds.capsule(number("radius", radius), number("half_length", half_length))


def hull(points: ArrayLike) -> Shape:
    """The solid convex hull of points (n, 3), about the origin as the body's centre. They must not lie in a plane."""
    corners = doubles("points", points, (None, 3))
    try:
        return _kds.hull(corners)
    except ValueError as error:
        raise ValueError(f"points: {error}") from None


def half_space(normal: ArrayLike, offset: float = 0.0) -> Shape:
    """All that is not beyond a plane: normal . x <= offset, seen from the body's centre. A floor, or a wall.

    The normal (3,) leads out of it, and is of unit length. For fixed bodies, which may move but not turn.
    """
    return _kds.half_space(vector("normal", normal), number("offset", offset))


def mesh(vertices: ArrayLike, triangles: ArrayLike, scale: float = 1.0) -> Shape:
    """A surface of triangles, about the origin as the body's centre; it has no inside. Use one for many bodies.

    vertices (n, 3); triangles (m, 3), whole numbers from 0 to n - 1; each vertex is multiplied by `scale`.
    """
    points = doubles("vertices", vertices, (None, 3))
    return _kds.mesh(points, triangles_of(triangles, len(points)), number("scale", scale))


def bending_mesh(times: ArrayLike, positions: ArrayLike, triangles: ArrayLike) -> Shape:
    """A surface of triangles whose vertices move on their own: a sheet of cloth, a skin (docs/deforming.md).

    times (k,), s, which ascend; positions (k, n, 3) of the vertices at these times, about the origin as the body's
    centre: between two times they move on straight lines, before the first and after the last they stand still. One
    time may be a number, its positions (n, 3). triangles (m, 3), whole numbers from 0 to n - 1; they may have no area.
    World.update_vertices() goes on from there.
    """
    when, where = keyframes(times, positions)
    if len(when) == 0:
        raise ValueError("times: must be at least one")
    return _kds.bending_mesh(when, where, triangles_of(triangles, len(where) // len(when)))


def heightfield(heights: ArrayLike, spacing: ArrayLike = (1, 1)) -> Shape:
    """The surface of a terrain, a mesh: heights (m, n) are z at y = (i - (m - 1) / 2) dy, x = (j - (n - 1) / 2) dx.

    spacing: (dx, dy), each > 0. Each cell has two triangles, which share the edge from its corner of least x and y to
    the opposite one.
    """
    rows_of_heights = doubles("heights", heights, (None, None))
    along_x, along_y = doubles("spacing", spacing, (2,))
    return _kds.heightfield(rows_of_heights.ravel(), rows_of_heights.shape[1], along_x, along_y)


def compound(
    parts: Iterable[Shape],
    positions: ArrayLike = (0, 0, 0),
    orientations: ArrayLike = UPRIGHT,
    about_centre_of_mass: bool = False,
) -> Shape:
    """Boxes, hulls and meshes as one body: it is in contact while one of its parts is. Use one for many bodies.

    Of each part the position of its centre (n, 3), seen from the body's centre, and its orientation (n, 4): unit
    quaternions w, x, y, z; or one for all. Parts may overlap. With about_centre_of_mass all are moved by one way, so
    that the body's centre is the centre of mass, about which a free body turns: parts have one density, what two share
    counts twice, and meshes have to be closed.
    """
    if not isinstance(parts, Iterable):
        raise ValueError(f"parts: must be several kds.Shape, and is {parts!r}")
    shapes = [shape_of(f"parts[{i}]", part) for i, part in enumerate(parts)]
    n = len(shapes)
    moved = flag("about_centre_of_mass", about_centre_of_mass)
    return _kds.compound(shapes, rows("positions", positions, n, 3), rows("orientations", orientations, n, 4), moved)


def read_mesh(file: str | os.PathLike[str], scale: float = 1.0) -> Shape:
    """A mesh from an OBJ or STL file. Triangles without an area are left out, and faces that cross themselves are cut as
    fans from their first corner, with warnings that count them."""
    name = path("file", file)
    shape, mended = _kds.read_mesh(name, number("scale", scale))
    for sentence in mended:
        warnings.warn(f"{name}: {sentence}", stacklevel=2)
    return shape
