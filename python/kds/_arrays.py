"""Arguments as arrays: what does not fit is said by name and shape."""

from __future__ import annotations

import math
import os
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kds._kds import Shape

Doubles = NDArray[np.float64]
Ids = NDArray[np.uint64]


def _shape_text(shape: tuple[int | None, ...]) -> str:
    sizes = ["n" if size is None else str(size) for size in shape]
    return "(" + ", ".join(sizes) + ("," if len(sizes) == 1 else "") + ")"


def array_of(name: str, value: ArrayLike) -> NDArray[Any]:
    """The value as an array of any type and shape. What a masked array hides has no value here: it is refused."""
    parts = value if isinstance(value, (list, tuple)) else (value,)
    if any(isinstance(part, np.ma.MaskedArray) and np.ma.is_masked(part) for part in parts):
        raise ValueError(f"{name}: has entries that are masked")
    try:
        return np.asarray(value)
    except (ValueError, TypeError) as error:
        raise ValueError(f"{name}: must be an array: {error}") from None


def doubles(name: str, value: ArrayLike, shape: tuple[int | None, ...]) -> Doubles:
    """The value as an array of doubles of this shape, in which None stands for any size. Nothing is broadcast."""
    array = array_of(name, value)
    if array.dtype.kind not in "iuf":
        raise ValueError(f"{name}: must be real numbers, and has the dtype {array.dtype}")
    fits = array.ndim == len(shape) and all(want in (None, has) for want, has in zip(shape, array.shape))
    if not fits:
        raise ValueError(f"{name}: must have the shape {_shape_text(shape)}, and has {array.shape}")
    return np.ascontiguousarray(array, dtype=np.float64)


def triangles_of(value: ArrayLike, vertices: int) -> NDArray[np.uint32]:
    """(m, 3) numbers of vertices."""
    corners = array_of("triangles", value)
    if corners.dtype.kind not in "iu" or corners.ndim != 2 or corners.shape[1] != 3:
        raise ValueError(
            f"triangles: must be whole numbers of shape (m, 3), and is {corners.dtype} of shape {corners.shape}"
        )
    if corners.size and not 0 <= corners.min() <= corners.max() < vertices:
        found = f"from {corners.min()} to {corners.max()}"
        raise ValueError(f"triangles: must be from 0 to {vertices - 1}, and go {found}")
    return corners.astype(np.uint32)


def keyframes(times: ArrayLike, positions: ArrayLike) -> tuple[Doubles, Doubles]:
    """Times (k,), and positions (k, n, 3) as (k * n, 3): or one of each."""
    if array_of("times", times).ndim == 0:
        when = np.array([number("times", times)])
        where = doubles("positions", positions, (None, 3))[None]
    else:
        when = doubles("times", times, (None,))
        if len(when) == 0:
            where = array_of("positions", positions)
            if where.size:
                raise ValueError(f"positions: must be none, as there are no times, and has the shape {where.shape}")
            return when, np.empty((0, 3))
        where = doubles("positions", positions, (None, None, 3))
        if len(where) != len(when):
            raise ValueError(f"positions: must be of {len(when)} times, and has the shape {where.shape}")
    return when, where.reshape(-1, 3)


def vector(name: str, value: ArrayLike) -> Doubles:
    return doubles(name, value, (3,))


def number(name: str, value: Any) -> float:
    if isinstance(value, (bool, np.bool_, str)) or np.ma.is_masked(value):
        raise ValueError(f"{name}: must be a number, and is {value!r}")
    try:
        return float(value)
    except (TypeError, ValueError):
        raise ValueError(f"{name}: must be a number, and is {value!r}") from None


def whole(name: str, value: Any, most: int = 2**63 - 1) -> int:
    if isinstance(value, (int, np.integer)) and not isinstance(value, bool) and 0 <= value <= most:
        return int(value)
    raise ValueError(f"{name}: must be a whole number from 0 to {most}, and is {value!r}")


def flag(name: str, value: Any) -> bool:
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    raise ValueError(f"{name}: must be True or False, and is {value!r}")


def word(name: str, value: Any) -> str:
    if isinstance(value, str):
        return value
    raise ValueError(f"{name}: must be a string, and is {value!r}")


def finite(name: str, value: Any) -> float:
    result = number(name, value)
    if not math.isfinite(result):
        raise ValueError(f"{name}: must be finite, and is {result}")
    return result


def rows(name: str, value: ArrayLike, n: int, columns: int) -> Doubles:
    """(n, columns) doubles; one row of `columns` counts for all."""
    array = array_of(name, value)
    if array.dtype.kind in "iuf" and array.shape == (columns,):
        return np.broadcast_to(np.asarray(array, dtype=np.float64), (n, columns))
    return doubles(name, value, (n, columns))


def column(name: str, value: ArrayLike, n: int) -> Doubles:
    """n doubles; one number counts for all."""
    array = array_of(name, value)
    if array.ndim == 0 and array.dtype.kind in "iuf":
        return np.full(n, float(array))
    return doubles(name, value, (n,))


def _wholes(name: str, value: ArrayLike) -> NDArray[Any]:
    """An array, in which whole numbers on both sides of 2^63 are whole: NumPy makes doubles of them."""
    array = array_of(name, value)
    if array.dtype.kind == "f" and not isinstance(value, (np.ndarray, np.generic)):
        exact = np.array(value, dtype=object)
        if all(isinstance(each, (int, np.integer)) and 0 <= each < 2**64 for each in exact.flat):
            return exact.astype(np.uint64)
    return array


def unsigned(name: str, value: ArrayLike, n: int, bits: int) -> NDArray[Any]:
    """n whole numbers from 0 to 2^bits - 1, with 32 or 64 bits; one counts for all."""
    array = _wholes(name, value)
    if array.ndim == 0:
        array = np.full(n, array)
    if array.dtype.kind not in "iu" or array.shape != (n,):
        raise ValueError(f"{name}: must be whole numbers of shape ({n},), and is {array.dtype} of shape {array.shape}")
    if n and (int(array.min()) < 0 or int(array.max()) >= 2**bits):
        raise ValueError(f"{name}: must be numbers of {bits} bits, from 0 to {2**bits - 1:#x}")
    return array.astype(np.uint32 if bits == 32 else np.uint64)


def flags(name: str, value: ArrayLike, n: int) -> NDArray[np.uint8]:
    """n of 0 and 1; one bool counts for all."""
    array = array_of(name, value)
    if array.ndim == 0:
        array = np.full(n, array)
    if array.dtype.kind != "b" or array.shape != (n,):
        raise ValueError(f"{name}: must be bools of shape ({n},), and is {array.dtype} of shape {array.shape}")
    return array.astype(np.uint8)


def ids(name: str, value: ArrayLike) -> Ids:
    """Ids of bodies, (n,)."""
    array = _wholes(name, value)
    if array.size == 0 and array.ndim == 1:
        return np.empty(0, np.uint64)
    if array.dtype.kind not in "iu" or array.ndim != 1 or array.min() < 0:
        raise ValueError(f"{name}: must be ids of bodies of shape (n,), and is {array.dtype} of shape {array.shape}")
    return np.ascontiguousarray(array, dtype=np.uint64)


def identity(name: str, value: Any) -> int:
    """One id."""
    if isinstance(value, (int, np.integer)) and not isinstance(value, bool) and 0 <= value < 2**64:
        return int(value)
    raise ValueError(f"{name}: must be the id of a body, and is {value!r}")


def one_or_more(name: str, value: ArrayLike) -> Ids:
    """The id of a body, or ids (n,)."""
    return np.array([identity(name, value)], np.uint64) if np.isscalar(value) else ids(name, value)


def shape_of(name: str, value: Any) -> Shape:
    if isinstance(value, Shape):
        return value
    raise ValueError(f"{name}: must be a kds.Shape, and is {value!r}")


def path(name: str, value: Any) -> str:
    try:
        return os.fsdecode(value)
    except TypeError:
        raise ValueError(f"{name}: must be a path, and is {value!r}") from None
