"""Shapes of clips. Numbers are in world units."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike, fspath
from typing import Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from ._rara import Clip

ClipLike = Union[Clip, str]


def _text(shape: str, *parts: Union[float, Sequence[float]]) -> str:
    numbers = np.concatenate([np.ravel(np.asarray(part, np.float64)) for part in parts]).tolist()
    return f"{shape}:" + ",".join(repr(number).removesuffix(".0") for number in numbers)


class Plane(Clip):
    """Keeps the points p with dot(normal, p) + offset >= 0."""

    def __new__(cls, normal: Sequence[float], offset: float = 0.0) -> Plane:
        return super().__new__(cls, _text("plane", normal, offset))


class Slab(Clip):
    """Keeps the points p with 0 <= dot(normal, p) + offset <= thickness."""

    def __new__(cls, normal: Sequence[float], offset: float, thickness: float) -> Slab:
        return super().__new__(cls, _text("slab", normal, offset, thickness))


class Box(Clip):
    """Keeps the inside of a box with half sizes, turned by a quaternion w, x, y, z."""

    def __new__(cls, centre: Sequence[float], half: Sequence[float], rotation: Sequence[float] = ()) -> Box:
        return super().__new__(cls, _text("box", centre, half, rotation))


class Sphere(Clip):
    """Keeps the inside of a sphere."""

    def __new__(cls, centre: Sequence[float], radius: float) -> Sphere:
        return super().__new__(cls, _text("sphere", centre, radius))


class Ellipsoid(Clip):
    """Keeps the inside of an ellipsoid with radii, turned by a quaternion w, x, y, z."""

    def __new__(cls, centre: Sequence[float], radii: Sequence[float], rotation: Sequence[float] = ()) -> Ellipsoid:
        return super().__new__(cls, _text("ellipsoid", centre, radii, rotation))


class Cylinder(Clip):
    """Keeps the inside of a cylinder between discs around two points."""

    def __new__(cls, start: Sequence[float], end: Sequence[float], radius: float) -> Cylinder:
        return super().__new__(cls, _text("cylinder", start, end, radius))


class Capsule(Clip):
    """Keeps what is within a radius of the line between two points."""

    def __new__(cls, start: Sequence[float], end: Sequence[float], radius: float) -> Capsule:
        return super().__new__(cls, _text("capsule", start, end, radius))


class Cone(Clip):
    """Keeps the inside of a cone from its apex to a disc around its base."""

    def __new__(cls, apex: Sequence[float], base: Sequence[float], radius: float) -> Cone:
        return super().__new__(cls, _text("cone", apex, base, radius))


class Polygon(Clip):
    """Keeps the prism over a polygon with these corners [N, 2], along "x", "y" or "z", between two heights if given."""

    def __new__(cls, axis: str, corners: ArrayLike, heights: Optional[tuple[float, float]] = None) -> Polygon:
        between = "" if heights is None else f"={float(heights[0])!r}..{float(heights[1])!r}"
        pairs = (f"{float(u)!r},{float(v)!r}" for u, v in np.asarray(corners, np.float64))
        return super().__new__(cls, f"polygon:{axis}{between};" + ";".join(pairs))


class Mesh(Clip):
    """Keeps the inside of the closed mesh of a file, scaled, turned by a quaternion w, x, y, z, and then moved.

    With `winding`, the mesh may be open or cut itself: its inside is where the winding number is not zero.
    """

    def __new__(
        cls,
        path: Union[str, PathLike[str]],
        *,
        scale: float = 1.0,
        rotation: Sequence[float] = (1.0, 0.0, 0.0, 0.0),
        position: Sequence[float] = (0.0, 0.0, 0.0),
        winding: bool = False,
    ) -> Mesh:
        numbers = [",".join(repr(float(number)) for number in one) for one in ((scale,), rotation, position)]
        parts = [f"{name}={text}" for name, text in zip(("scale", "turn", "at"), numbers)]
        return super().__new__(cls, ";".join([f"mesh:{fspath(path)}", *parts, *(["winding"] if winding else [])]))
