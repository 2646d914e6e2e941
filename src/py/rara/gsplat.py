"""`rasterize`, with the arguments and results of gsplat's `rasterization`."""

from __future__ import annotations

import importlib
import re
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._rara import Camera, Gaussians
from .clips import ClipLike
from .drawing import Renderer
from .errors import InvalidError

_MODES = {"RGB": (3, None), "D": (0, "D"), "ED": (0, "ED"), "RGB+D": (3, "D"), "RGB+ED": (3, "ED")}


def rasterize(
    means: Any, quats: Any, scales: Any, opacities: Any, colors: Any, viewmats: Any, Ks: Any, width: int, height: int,
    near_plane: float = 0.01, far_plane: float = 1e10, radius_clip: float = 0.0, eps2d: float = 0.3,
    sh_degree: Optional[int] = None, packed: bool = True, tile_size: int = 16, backgrounds: Any = None,
    render_mode: str = "RGB", sparse_grad: bool = False, absgrad: bool = False, rasterize_mode: str = "classic",
    channel_chunk: int = 32, distributed: bool = False, camera_model: str = "pinhole", *, clip: Optional[ClipLike] = None,
    renderer: Optional[Renderer] = None, **settings: Any,
) -> tuple[Any, Any, dict[str, Any]]:
    """Draws N Gaussians by C cameras, with the arguments of gsplat's `rasterization`, and cuts them by a clip.

    `means` [N, 3], `quats` [N, 4] (w, x, y, z), `scales` [N, 3], `opacities` [N]; `colors` [N, 3] or [C, N, 3] from 0, or with
    `sh_degree` (0 to 3) spherical harmonics [N, K, 3]; `viewmats` [C, 4, 4] are world-to-camera matrices, `Ks` [C, 3, 3]
    intrinsics, pixels; `backgrounds` [C, 3]. Returns colours [C, height, width, D] with D of `render_mode` "RGB" 3, "D" and
    "ED" 1 (accumulated and expected depth), "RGB+D" and "RGB+ED" 4; alphas [C, height, width, 1]; and a dictionary. They are
    torch tensors where `means` is one, else float32 arrays, and have no gradients.

    `clip`, `renderer` and the settings are those of `Renderer.render`. What only says how gsplat works is taken and ignored:
    packed, tile_size, sparse_grad, absgrad, channel_chunk and distributed. `far_plane` cuts Gaussians as a clip does.
    InvalidError names an argument that rara has not: radius_clip, other camera models than "pinhole" and "ortho".
    """
    if render_mode not in _MODES:
        raise InvalidError(f"render_mode is {render_mode!r}; give one of {', '.join(_MODES)}")
    if rasterize_mode not in ("classic", "antialiased"):
        raise InvalidError(f"rasterize_mode is {rasterize_mode!r}; give classic or antialiased")
    if camera_model not in ("pinhole", "ortho"):
        raise InvalidError(f"camera_model is {camera_model!r}; give pinhole or ortho")
    if radius_clip:
        raise InvalidError(f"radius_clip is {radius_clip}; rara draws small splats too: give 0")
    if sh_degree not in (None, 0, 1, 2, 3):
        raise InvalidError(f"sh_degree is {sh_degree}; give 0 to 3, or None for colors")
    if "background" in settings:
        raise InvalidError("background is not an argument here; give backgrounds")
    matrices = _array("viewmats", viewmats, (None, 4, 4))
    count = len(matrices)
    lenses = _array("Ks", Ks, (count, 3, 3))
    behind = np.zeros((count, 3)) if backgrounds is None else _array("backgrounds", backgrounds, (count, 3))
    shown = _array("colors", colors, None)
    per_camera = sh_degree is None and shown.ndim == 3
    if per_camera and len(shown) != count:
        raise InvalidError(f"colors has the shape {list(shown.shape)}; give [N, 3], or [{count}, N, 3] for each camera")
    if sh_degree is not None:
        wanted = (sh_degree + 1) ** 2
        if shown.ndim != 3 or shown.shape[1] < wanted:
            raise InvalidError(f"colors has the shape {list(shown.shape)}; give [N, K, 3], K at least {wanted} for sh_degree {sh_degree}")
        shown = shown[:, :wanted]

    def made(of: NDArray[Any]) -> Gaussians:
        coloured: dict[str, Any] = {"colors": np.maximum(of, 0)} if sh_degree is None else {"sh": of}
        antialiased = rasterize_mode == "antialiased"
        trained: dict[str, Any] = {"antialiased": antialiased, "low_pass": eps2d, "alpha_max": 0.999}
        try:
            return Gaussians(means, quats, scales, opacities, **trained, **coloured)
        except InvalidError as error:
            raise InvalidError(re.sub(r"^sh\b", "colors", str(error))) from None

    renderer = renderer or _default()
    scene = None if per_camera else made(shown)
    pairs = zip(matrices, lenses)
    cameras = [Camera.from_matrices(matrix, lens, width, height, camera_model == "ortho") for matrix, lens in pairs]
    channels, depth = _MODES[render_mode]
    images = np.empty((count, height, width, channels + (depth is not None)), np.float32)
    alphas = np.empty((count, height, width, 1), np.float32)
    stats = []
    for at, camera in enumerate(cameras):
        camera = camera.replace(near_cut=near_plane, clip_far=far_plane if far_plane < 1e10 else None)
        of = made(shown[at]) if scene is None else scene
        picture = renderer.render(of, camera, clip, **settings)
        alphas[at] = picture.array[..., 3:]
        if channels:
            images[at, ..., :3] = picture.array[..., :3] + (1 - alphas[at]) * behind[at]
        if depth:
            mean = renderer.channels(of, camera, clip, names=["depth"], **settings)["depth"]
            images[at, ..., -1] = mean * alphas[at, ..., 0] if depth == "D" else mean
        stats.append(picture.stats)
    meta = {"width": width, "height": height, "n_cameras": count, "stats": stats}
    if type(means).__module__.partition(".")[0] == "torch":
        torch = importlib.import_module("torch")
        return torch.from_numpy(images), torch.from_numpy(alphas), meta
    return images, alphas, meta


_shared: list[Renderer] = []


def _default() -> Renderer:
    if not _shared:
        _shared.append(Renderer())
    return _shared[0]


def _array(name: str, given: ArrayLike, shape: Optional[tuple[Optional[int], ...]]) -> NDArray[Any]:
    tensor: Any = given
    array = np.asarray(tensor.detach() if hasattr(tensor, "requires_grad") else tensor)
    fits = shape is None or (array.ndim == len(shape) and all(b in (None, a) for a, b in zip(array.shape, shape)))
    if array.dtype.kind not in "fiu" or not fits:
        wanted = f"[{', '.join('C' if side is None else str(side) for side in shape)}]" if shape else "[N, 3]"
        raise InvalidError(f"{name} is an array of {array.dtype} {list(array.shape)}; give float32 {wanted}")
    return array
