"""Drawing: pictures, channels and sections of scenes."""

from __future__ import annotations

import dataclasses
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _rara
from ._rara import Camera, Clip, Picture
from .clips import ClipLike
from .errors import InvalidError
from .scenes import SceneLike, _bar


@dataclasses.dataclass(frozen=True)
class Shot:
    """What a picture of several shows: a camera, a clip, or both; what is None is that of all. `section` is a clip that also cuts
    layers with clips of their own."""

    camera: Optional[Camera] = None
    clip: Optional[ClipLike] = None
    section: Optional[ClipLike] = None


class Renderer(_rara.Renderer):
    """A device, and the scene on it.

    `device` is a number or a part of a name of `rara.devices()`, or None for the best one. `validation` loads the Khronos
    validation layer, whose messages become ValidationError. `cache` is the folder in which compiled pipelines are kept, "" for
    none, None for the user's. DeviceError says what is missing: a Vulkan loader, a driver, or a feature of the device.

    In all methods, `scene` is a rara.Scene, rara.Layer or rara.Gaussians, which is uploaded unless it is there already.
    `camera` is by default the one that frames the scene; `size` is the width and height, pixels. `clip` is a rara.Clip or a
    text, and `section` likewise one that also cuts layers with clips of their own. Settings have the names and values of the
    command line: mode="exact", background=(1, 1, 1), sh_degree=1, sigma=2.5, preset="fast" and others. The picture is
    transparent where no background is given. Other threads of Python run while the device works; several threads that use one
    renderer wait for each other.
    """

    def render(
        self,
        scene: SceneLike,
        camera: Optional[Camera] = None,
        clip: Optional[ClipLike] = None,
        *,
        section: Optional[ClipLike] = None,
        size: Optional[Sequence[int]] = None,
        **settings: Any,
    ) -> Picture:
        """Draws a picture of a scene."""
        return self._render((scene, camera, clip, section, size, settings))

    def pictures(
        self,
        scene: SceneLike,
        shots: Iterable[Union[Shot, Camera, ClipLike]],
        camera: Optional[Camera] = None,
        clip: Optional[ClipLike] = None,
        *,
        size: Optional[Sequence[int]] = None,
        ahead: int = 2,
        progress: bool = False,
        **settings: Any,
    ) -> Iterator[Picture]:
        """Draws a picture for each shot, camera or clip, so many `ahead` on a thread, for which as many more shots are asked for.
        `progress` shows a bar if tqdm is installed."""
        if isinstance(shots, (str, Clip, Camera, Shot)):
            raise InvalidError(f"shots is a {type(shots).__name__}; give several, as in a list")
        waiting: deque[Future[Picture]] = deque()
        bar = _bar(total=len(shots) if isinstance(shots, Sequence) else None) if progress else None
        with ThreadPoolExecutor(1, "rara") as thread:
            try:
                for shot in shots:
                    if not isinstance(shot, Shot):
                        shot = Shot(camera=shot) if isinstance(shot, Camera) else Shot(clip=shot)
                    seen, kept = shot.camera or camera, shot.clip or clip
                    request = scene, seen, kept, shot.section, size, settings
                    waiting.append(thread.submit(self._render, request))
                    while len(waiting) > max(ahead, 0):
                        yield waiting.popleft().result()
                        if bar is not None:
                            bar.update()
                while waiting:
                    yield waiting.popleft().result()
                    if bar is not None:
                        bar.update()
            finally:
                for one in waiting:
                    one.cancel()

    def channels(
        self,
        scene: SceneLike,
        camera: Optional[Camera] = None,
        clip: Optional[ClipLike] = None,
        *,
        names: Sequence[str] = ("depth", "normal", "layer", "weight", "count"),
        section: Optional[ClipLike] = None,
        size: Optional[Sequence[int]] = None,
        **settings: Any,
    ) -> dict[str, NDArray[np.float32]]:
        """Draws what pixels are made of, float32 [height, width] by name: the mean "depth" along the view axis, world units; the
        mean "normal" [height, width, 3] of thinnest axes, in the world; the number of the "layer" that adds most, -1 for none;
        the mean "weight" that the clip leaves; and the "count" of splats."""
        names = list(dict.fromkeys(names))
        drawn = iter(self._channels((scene, camera, clip, section, size, settings), names))
        return {name: np.stack([next(drawn) for _ in "xyz"], -1) if name == "normal" else next(drawn) for name in names}

    def pick(
        self,
        scene: SceneLike,
        rect: tuple[int, int, int, int],
        camera: Optional[Camera] = None,
        clip: Optional[ClipLike] = None,
        *,
        size: Optional[Sequence[int]] = None,
        **settings: Any,
    ) -> dict[str, NDArray[Any]]:
        """Finds the Gaussian that adds most to each pixel of a rectangle (left, top, width, height): its "layer" and its
        "number" in the scene, which counts on from layer to layer, int64 [height, width], -1 where there is none, and the "alpha"
        that it adds, float32."""
        found = self._pick((scene, camera, clip, None, size, settings), rect)
        return dict(zip(("layer", "number", "alpha"), found))

    def slice(self, scene: SceneLike, shot: Shot, clip: Optional[ClipLike] = None, **settings: Any) -> Picture:
        """Draws what lies on the plane of a section of `rara.section`: the mean colour of the splats there."""
        if shot.section is None:
            raise InvalidError("shot has no section; give one of rara.section")
        return self._slice((scene, shot.camera, clip, None, None, settings), shot.section)

    def panorama(
        self,
        scene: SceneLike,
        camera: Camera,
        clip: Optional[ClipLike] = None,
        *,
        width: int = 2048,
        section: Optional[ClipLike] = None,
        **settings: Any,
    ) -> Picture:
        """Draws all that is around a camera: longitudes across, with the direction of view in the middle, latitudes down."""
        return self._panorama((scene, camera, clip, section, None, settings), width)


def truth(
    scene: SceneLike,
    camera: Optional[Camera] = None,
    clip: Optional[ClipLike] = None,
    *,
    section: Optional[ClipLike] = None,
    size: Optional[Sequence[int]] = None,
    **settings: Any,
) -> Picture:
    """Draws a picture by the reference, on the processor in double precision: slow, and what errors are measured against."""
    return _rara.truth((scene, camera, clip, section, size, settings))


def section(
    scene: SceneLike,
    axis: str,
    at: float,
    *,
    size: Sequence[int] = (1024, 1024),
    up: Optional[Sequence[float]] = None,
    scale: Optional[float] = None,
    thickness: Optional[float] = None,
) -> Shot:
    """Returns the shot of a section across "x" or "sagittal", "y" or "coronal", "z" or "axial"; "!x" sees it from the other side.

    `at` is a share, 0 to 1, of the scene's bounds. `thickness` is that of a slab, and `scale` the world units to a pixel;
    without them all that is behind the plane is kept and shown. All sections across an axis have one scale.
    """
    if not 0 <= at <= 1:
        raise InvalidError(f"at is {at}; give a share from 0 to 1")
    for name, length in (("scale", scale), ("thickness", thickness)):
        if length is not None and not 0 < length < np.inf:
            raise InvalidError(f"{name} is {length}; give a finite number above zero")
    camera, plane = _rara.section(scene, axis, at, size=size, up=up, scale=scale, thickness=thickness)
    return Shot(camera, section=plane)


def sweep(start: ClipLike, end: ClipLike, frames: int, scene: Optional[SceneLike] = None) -> list[Clip]:
    """Returns clips that move from one to another of the same shapes. `scene` is for lengths in percent."""
    if not 1 <= frames <= 1_000_000:
        raise InvalidError(f"frames is {frames}; give 1 to 1000000")
    first = start if isinstance(start, Clip) else Clip(start)
    return [first.between(end, at / max(frames - 1, 1), scene) for at in range(frames)]
