"""Scenes: layers of Gaussians, and reading them."""

from __future__ import annotations

import dataclasses
import importlib
from collections.abc import Callable, Iterator, Sequence
from os import PathLike
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _rara
from ._rara import Clip, Gaussians
from .clips import ClipLike, _numbers
from .errors import InvalidError

SceneLike = Union["Scene", "Layer", Gaussians]


@dataclasses.dataclass(frozen=True, eq=False)
class Layer:
    """A layer of a scene: Gaussians with a name that are placed, faded, hidden and cut together.

    `position` (world units), `rotation` (w, x, y, z) and `scale` place it, and `opacity`, 0 to 1, fades it. `clip` cuts it in
    place of a picture's clip; "whole" is no cut at all. `dataclasses.replace(layer, opacity=0.5)` is another layer.
    """

    name: str
    gaussians: Gaussians
    position: Sequence[float] = (0.0, 0.0, 0.0)
    rotation: Sequence[float] = (1.0, 0.0, 0.0, 0.0)
    scale: float = 1.0
    opacity: float = 1.0
    visible: bool = True
    clip: Optional[ClipLike] = None

    def __post_init__(self) -> None:
        for name, given, count in (("position", self.position, 3), ("rotation", self.rotation, 4)):
            object.__setattr__(self, name, tuple(_numbers(name, given, count)))
        # A text would be parsed, and its mesh read, for each picture.
        if isinstance(self.clip, str) and self.clip.strip() != "whole":
            object.__setattr__(self, "clip", Clip(self.clip))


@dataclasses.dataclass(frozen=True, eq=False)
class Scene:
    """Layers of Gaussians that are sorted and blended together, by number or name: `scene[0]`, `scene["skin"]`.

    Gaussians become layers that are named by their numbers. `up` is the direction that is up in pictures that frame the scene.
    `report` has the numbers of Gaussians that reading has "dropped" and "repaired", and "notes". Where a scene is wanted, a
    layer or Gaussians may stand for it.
    """

    layers: Sequence[Union[Layer, Gaussians]]
    up: Optional[Sequence[float]] = None
    report: dict[str, Any] = dataclasses.field(default_factory=lambda: {"dropped": 0, "repaired": 0, "notes": []}, repr=False)

    def __post_init__(self) -> None:
        named = (layer if isinstance(layer, Layer) else Layer(str(number), layer) for number, layer in enumerate(self.layers))
        object.__setattr__(self, "layers", tuple(named))

    @property
    def bounds(self) -> list[list[float]]:
        """Two corners of the box that holds all but the outermost percent of the centres at each end of each axis."""
        return _rara.bounds(self)

    def replace(self, name: str, /, **changes: Any) -> Scene:
        """Returns the scene with changes of the layer of a name: `scene.replace("skin", opacity=0.5, clip="plane:x=50%")`.

        A renderer that has the scene on its device uploads nothing again for that.
        """
        changed = dataclasses.replace(self[name], **changes)
        layers = [changed if layer is self[name] else layer for layer in self]
        return dataclasses.replace(self, layers=layers)

    def merged(self) -> Gaussians:
        """Returns one set of the visible layers, where they are placed and as faded, with the properties that all of them
        have. InvalidError names layers that were trained differently, and a layer with a clip of its own: `rara.bake` bakes it."""
        return _rara.merged(self)

    def save(self, path: Union[str, PathLike[str]], *, up: Optional[Sequence[float]] = None) -> int:
        """Writes `merged` to a file as `Gaussians.save` does; `up` is by default that of the scene."""
        return self.merged().save(path, up=self.up if up is None else up)

    def __getitem__(self, key: Union[int, str]) -> Layer:
        if isinstance(key, int):
            return list(self)[key]
        for layer in self:
            if layer.name == key:
                return layer
        raise KeyError(f"there is no layer {key!r}; there are {[layer.name for layer in self]}")

    def __iter__(self) -> Iterator[Layer]:
        return (layer for layer in self.layers if isinstance(layer, Layer))

    def __len__(self) -> int:
        return len(self.layers)


def load(
    *paths: Union[str, PathLike[str]],
    select: Sequence[str] = (),
    progress: Union[bool, Callable[[int, int], object]] = False,
) -> Scene:
    """Reads scene files as layers: all formats that `rara render` reads, lists of layers, and folders of trainers.

    `select` are texts NAME=PREDICATE that move Gaussians to layers of their own, as "vessels=label in 3,4". `progress` is
    called with the bytes that are read and those of the file; True shows a bar if tqdm is installed. IoError and
    FormatError name the file that cannot be read.
    """
    if not paths:
        raise TypeError("load() takes at least one path")
    bar = _bar(unit="B", unit_scale=True) if progress is True else None

    def tell(done: int, total: int) -> None:
        if bar is not None:
            bar.total = total
            bar.update(done - bar.n)

    called = progress if callable(progress) else tell if bar is not None else None
    layers, up, report = _rara.load(paths, list(select), called)
    return Scene([Layer(*fields) for fields in layers], up, report)


def bake(
    scene: SceneLike,
    clip: Optional[ClipLike] = None,
    *,
    mode: str = "exact",
    sigma: float = 3.0,
    children: int = 1,
    leave: float = 1.0,
) -> tuple[Scene, dict[str, int]]:
    """Makes a scene that shows a cut without a clip, in any viewer, and counts of what was done.

    Gaussians outside the clip, or outside the clip that their layer has of its own, are dropped, and cut ones replaced by 1 to 3
    `children`. `mode`, `sigma` and `leave` are those of `rara bake`. Layers stay where they are, and have no clips.
    """
    layers = scene if isinstance(scene, Scene) else Scene([scene])
    baked, counts = _rara.bake(layers, clip, mode, (sigma, children, leave))
    made = [dataclasses.replace(layer, gaussians=one, clip=None) for layer, one in zip(layers, baked)]
    return dataclasses.replace(layers, layers=made), counts


def _bar(**options: Any) -> Any:
    try:
        return importlib.import_module("tqdm.auto").tqdm(**options)
    except ImportError:
        return None


def from_3dgs(
    xyz: ArrayLike,
    features_dc: ArrayLike,
    features_rest: Optional[ArrayLike],
    scaling: ArrayLike,
    rotation: ArrayLike,
    opacity: ArrayLike,
) -> Gaussians:
    """Makes Gaussians of the raw numbers of 3DGS's trainer, by its names: logarithms of scales, and logits of opacities.

    `xyz` [N, 3], `features_dc` [N, 1, 3], `features_rest` [N, K - 1, 3] or None, `scaling` [N, 3], `rotation` [N, 4] (w, x,
    y, z) and `opacity` [N, 1] are read as a .ply file is: what is not finite is dropped, and `report` says how much.
    """
    names = ["x y z", "f_dc_0 f_dc_1 f_dc_2", "", "opacity", "scale_0 scale_1 scale_2", "rot_0 rot_1 rot_2 rot_3"]
    given = {"xyz": xyz, "features_dc": features_dc, "features_rest": features_rest, "opacity": opacity}
    columns: list[NDArray[Any]] = []
    for name, array in {**given, "scaling": scaling, "rotation": rotation}.items():
        numbers = np.zeros((len(columns[0]), 0, 3)) if array is None else np.asarray(array)
        if name == "features_rest" and numbers.ndim == 3:
            numbers = numbers.transpose(0, 2, 1)
            names[2] = " ".join(f"f_rest_{at}" for at in range(3 * numbers.shape[2]))
        wanted = len(names[len(columns)].split())
        if numbers.dtype.kind not in "fiu" or numbers.ndim < 2 or numbers.size != numbers.shape[0] * wanted:
            raise InvalidError(f"{name} is an array of {numbers.dtype} {list(numbers.shape)}; give float32 [N, ...] of {wanted} numbers each")
        if columns and len(numbers) != len(columns[0]):
            raise InvalidError(f"{name} has {len(numbers)} rows; give {len(columns[0])}, as many as xyz")
        columns.append(numbers.reshape(len(numbers), wanted))
    header = "".join(f"property float {name}\n" for name in " ".join(names).split())
    start = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(columns[0])}\n{header}end_header\n"
    return Gaussians.from_bytes(start.encode() + np.hstack(columns).astype("<f4").tobytes(), "arrays")
