"""Shapes of clips. Numbers are in world units."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from ._rara import Clip
from .errors import InvalidError

ClipLike = Union[Clip, str]


def _numbers(name: str, given: Any, count: int) -> list[float]:
    """The finite numbers of an argument, of which there are so many."""
    try:
        array = np.asarray(given, np.float64)
    except (TypeError, ValueError):
        array = np.empty((0, 0))
    if array.shape != ((count,) if count > 1 else ()) or not np.isfinite(array).all():
        raise InvalidError(f"{name} is {given!r}; give {f'{count} finite numbers' if count > 1 else 'a finite number'}")
    return array.ravel().tolist()


def _text(shape: str, **parts: tuple[Any, int]) -> str:
    given = [_numbers(name, *part) for name, part in parts.items() if part[0] is not None]
    return f"{shape}:" + ",".join(repr(number).removesuffix(".0") for numbers in given for number in numbers)


class Plane(Clip):
    """Keeps the points p with dot(normal, p) + offset >= 0."""

    def __new__(cls, normal: Sequence[float], offset: float = 0.0) -> Plane:
        return super().__new__(cls, _text("plane", normal=(normal, 3), offset=(offset, 1)))


class Slab(Clip):
    """Keeps the points p with 0 <= dot(normal, p) + offset <= thickness."""

    def __new__(cls, normal: Sequence[float], offset: float, thickness: float) -> Slab:
        return super().__new__(cls, _text("slab", normal=(normal, 3), offset=(offset, 1), thickness=(thickness, 1)))


class Box(Clip):
    """Keeps the inside of a box with half sizes, turned by a quaternion w, x, y, z."""

    def __new__(cls, centre: Sequence[float], half: Sequence[float], rotation: Optional[Sequence[float]] = None) -> Box:
        return super().__new__(cls, _text("box", centre=(centre, 3), half=(half, 3), rotation=(rotation, 4)))


class Sphere(Clip):
    """Keeps the inside of a sphere."""

    def __new__(cls, centre: Sequence[float], radius: float) -> Sphere:
        return super().__new__(cls, _text("sphere", centre=(centre, 3), radius=(radius, 1)))


class Ellipsoid(Clip):
    """Keeps the inside of an ellipsoid with radii, turned by a quaternion w, x, y, z."""

    def __new__(cls, centre: Sequence[float], radii: Sequence[float], rotation: Optional[Sequence[float]] = None) -> Ellipsoid:
        return super().__new__(cls, _text("ellipsoid", centre=(centre, 3), radii=(radii, 3), rotation=(rotation, 4)))


class Cylinder(Clip):
    """Keeps the inside of a cylinder between discs around two points."""

    def __new__(cls, start: Sequence[float], end: Sequence[float], radius: float) -> Cylinder:
        return super().__new__(cls, _text("cylinder", start=(start, 3), end=(end, 3), radius=(radius, 1)))


class Capsule(Clip):
    """Keeps what is within a radius of the line between two points."""

    def __new__(cls, start: Sequence[float], end: Sequence[float], radius: float) -> Capsule:
        return super().__new__(cls, _text("capsule", start=(start, 3), end=(end, 3), radius=(radius, 1)))


class Cone(Clip):
    """Keeps the inside of a cone from its apex to a disc around its base."""

    def __new__(cls, apex: Sequence[float], base: Sequence[float], radius: float) -> Cone:
        return super().__new__(cls, _text("cone", apex=(apex, 3), base=(base, 3), radius=(radius, 1)))


class Polygon(Clip):
    """Keeps the prism over a polygon with these corners [N, 2], along "x", "y" or "z", between two heights if given.

    Corners are (y, z) along "x", (x, z) along "y" and (x, y) along "z".
    """

    def __new__(cls, axis: str, corners: ArrayLike, heights: Optional[Sequence[float]] = None) -> Polygon:
        pairs = np.asarray(corners, np.float64)
        if axis not in ("x", "y", "z"):
            raise InvalidError(f"axis is {axis!r}; give x, y or z")
        if pairs.ndim != 2 or pairs.shape[1] != 2 or not np.isfinite(pairs).all():
            raise InvalidError(f"corners has the shape {list(pairs.shape)}; give [N, 2] finite numbers")
        between = "" if heights is None else "={!r}..{!r}".format(*_numbers("heights", heights, 2))
        return super().__new__(cls, f"polygon:{axis}{between};" + ";".join(f"{u!r},{v!r}" for u, v in pairs.tolist()))
