"""Clips: what stays visible. Numbers are in world units."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from os import PathLike, fspath
from typing import TYPE_CHECKING, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _rara

if TYPE_CHECKING:
    from .scenes import SceneLike

ClipLike = Union["Clip", str]


class Clip:
    """A region that stays visible, by the text of a shape or of an expression.

    Texts are those of the command line: "plane:0,0,1,-2", "!sphere:0,0,0,1", "all(box:0,0,0,1,1,1, not(plane:z=40%))".
    Lengths in percent are shares of the bounds of the scene that is cut. `a & b` keeps what both keep, `a | b` what either
    keeps, and `~a` what `a` does not keep. InvalidError says what is wrong with a text, and in which column.
    """

    __slots__ = ("_joined", "text")

    def __init__(self, text: str) -> None:
        _rara.check_clip(text)
        self.text = text
        self._joined: tuple[str, list[str]] = ("", [text])

    @staticmethod
    def all(clips: Iterable[ClipLike]) -> Clip:
        """Returns what all clips keep."""
        return _join("all", clips)

    @staticmethod
    def any(clips: Iterable[ClipLike]) -> Clip:
        """Returns what at least one of the clips keeps."""
        return _join("any", clips)

    def __and__(self, other: ClipLike) -> Clip:
        return Clip.all([self, other])

    def __or__(self, other: ClipLike) -> Clip:
        return Clip.any([self, other])

    def __invert__(self) -> Clip:
        return Clip("!" + self.text)

    def keeps(self, points: ArrayLike, scene: Optional[SceneLike] = None) -> NDArray[np.bool_]:
        """Says of each point, [N, 3], whether the clip keeps it: bool [N]. `scene` is for lengths in percent."""
        return _rara.clip_keeps(self, points, scene)

    def between(self, other: ClipLike, share: float, scene: Optional[SceneLike] = None) -> Clip:
        """Returns the clip at a share, 0 to 1, of the way to another one of the same shapes."""
        return Clip(_rara.clip_between(self, other, share, scene))

    @staticmethod
    def load(path: Union[str, PathLike[str]], name: Optional[str] = None) -> Clip:
        """Reads a clip, by its name or number, from a file that `save` or `rara --save-clip` wrote."""
        return Clip(_rara.load_clip(path, name))

    def save(self, path: Union[str, PathLike[str]], scene: Optional[SceneLike] = None) -> None:
        """Writes the clip to a JSON file for `load` and `rara --clip-file`. `scene` is for lengths in percent."""
        _rara.save_clip(self, path, scene)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Clip) and self.text == other.text

    def __hash__(self) -> int:
        return hash(self.text)

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return f"rara.Clip({self.text!r})"


def _join(operator: str, clips: Iterable[ClipLike]) -> Clip:
    operands: list[str] = []
    for clip in clips:
        of = clip if isinstance(clip, Clip) else Clip(clip)
        # What the same operator has joined is not nested, so that long chains are not deep.
        operands += of._joined[1] if of._joined[0] == operator else [of.text]
    made = Clip(f"{operator}({', '.join(operands)})")
    made._joined = (operator, operands)
    return made


def _text(shape: str, *parts: Union[float, Sequence[float]]) -> str:
    numbers = np.concatenate([np.ravel(np.asarray(part, np.float64)) for part in parts]).tolist()
    return f"{shape}:" + ",".join(repr(number).removesuffix(".0") for number in numbers)


class Plane(Clip):
    """Keeps the points p with dot(normal, p) + offset >= 0."""

    def __init__(self, normal: Sequence[float], offset: float = 0.0) -> None:
        super().__init__(_text("plane", normal, offset))


class Slab(Clip):
    """Keeps the points p with 0 <= dot(normal, p) + offset <= thickness."""

    def __init__(self, normal: Sequence[float], offset: float, thickness: float) -> None:
        super().__init__(_text("slab", normal, offset, thickness))


class Box(Clip):
    """Keeps the inside of a box with half sizes, turned by a quaternion w, x, y, z."""

    def __init__(self, centre: Sequence[float], half: Sequence[float], rotation: Sequence[float] = ()) -> None:
        super().__init__(_text("box", centre, half, rotation))


class Sphere(Clip):
    """Keeps the inside of a sphere."""

    def __init__(self, centre: Sequence[float], radius: float) -> None:
        super().__init__(_text("sphere", centre, radius))


class Ellipsoid(Clip):
    """Keeps the inside of an ellipsoid with radii, turned by a quaternion w, x, y, z."""

    def __init__(self, centre: Sequence[float], radii: Sequence[float], rotation: Sequence[float] = ()) -> None:
        super().__init__(_text("ellipsoid", centre, radii, rotation))


class Cylinder(Clip):
    """Keeps the inside of a cylinder between discs around two points."""

    def __init__(self, start: Sequence[float], end: Sequence[float], radius: float) -> None:
        super().__init__(_text("cylinder", start, end, radius))


class Capsule(Clip):
    """Keeps what is within a radius of the line between two points."""

    def __init__(self, start: Sequence[float], end: Sequence[float], radius: float) -> None:
        super().__init__(_text("capsule", start, end, radius))


class Cone(Clip):
    """Keeps the inside of a cone from its apex to a disc around its base."""

    def __init__(self, apex: Sequence[float], base: Sequence[float], radius: float) -> None:
        super().__init__(_text("cone", apex, base, radius))


class Polygon(Clip):
    """Keeps the prism over a polygon with these corners [N, 2], along "x", "y" or "z", between two heights if given."""

    def __init__(self, axis: str, corners: ArrayLike, heights: Optional[tuple[float, float]] = None) -> None:
        between = "" if heights is None else f"={float(heights[0])!r}..{float(heights[1])!r}"
        pairs = (f"{float(u)!r},{float(v)!r}" for u, v in np.asarray(corners, np.float64))
        super().__init__(f"polygon:{axis}{between};" + ";".join(pairs))


class Mesh(Clip):
    """Keeps the inside of the closed mesh of a file, scaled, turned by a quaternion w, x, y, z, and then moved.

    With `winding`, the mesh may be open or cut itself: its inside is where the winding number is not zero.
    """

    def __init__(
        self,
        path: Union[str, PathLike[str]],
        *,
        scale: float = 1.0,
        rotation: Sequence[float] = (1.0, 0.0, 0.0, 0.0),
        position: Sequence[float] = (0.0, 0.0, 0.0),
        winding: bool = False,
    ) -> None:
        numbers = [",".join(repr(float(number)) for number in one) for one in ((scale,), rotation, position)]
        parts = [f"{name}={text}" for name, text in zip(("scale", "turn", "at"), numbers)]
        super().__init__(";".join([f"mesh:{fspath(path)}", *parts, *(["winding"] if winding else [])]))
