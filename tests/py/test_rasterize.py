"""`rasterize` takes and returns the arrays of gsplat's `rasterization`."""

import sys
import types

import numpy as np
import pytest

import rara

from conftest import SIZE


@pytest.fixture(scope="module")
def given(gaussians):
    cameras = [rara.Camera.look_at(eye, (0, 0, 0), size=SIZE) for eye in ((0, 0, -3), (2, -1, -2))]
    arrays = gaussians.means, gaussians.quats, gaussians.scales, gaussians.opacities
    lens = np.stack([camera.viewmat for camera in cameras]), np.stack([camera.K for camera in cameras])
    return arrays, lens, cameras


def test_harmonics_and_cameras(renderer, gaussians, given):
    arrays, (viewmats, Ks), cameras = given
    colours, alphas, meta = rara.rasterize(
        *arrays, gaussians.sh, viewmats, Ks, *SIZE, sh_degree=3, near_plane=0.2, renderer=renderer
    )
    assert colours.shape == (2, 48, 64, 3) and alphas.shape == (2, 48, 64, 1) and meta["n_cameras"] == 2
    for camera, colour, alpha in zip(cameras, colours, alphas):
        picture = renderer.render(gaussians, camera).array
        np.testing.assert_allclose(np.concatenate([colour, alpha], -1), picture, atol=0.01)


def test_colours_backgrounds_depths_and_clips(renderer, gaussians, given):
    arrays, (viewmats, Ks), _ = given
    colors = np.tile(np.float32([[0.25, 0.5, 1]]), (len(gaussians), 1))
    options = {"renderer": renderer, "clip": "plane:1,0,0,0"}
    seen, alphas, _ = rara.rasterize(*arrays, colors, viewmats, Ks, *SIZE, render_mode="RGB+ED", **options)
    assert seen.shape == (2, 48, 64, 4)
    np.testing.assert_allclose(seen[..., :3], alphas * colors[0], atol=1e-5)
    solid = alphas[..., 0] > 0.5
    assert 1.5 < seen[solid][:, 3].min() and seen[solid][:, 3].max() < 4.5
    over, _, _ = rara.rasterize(*arrays, colors, viewmats, Ks, *SIZE, backgrounds=np.ones((2, 3)), **options)
    np.testing.assert_allclose(over, seen[..., :3] + 1 - alphas, atol=1e-5)
    whole = rara.rasterize(*arrays, colors, viewmats, Ks, *SIZE, renderer=renderer)[1]
    assert alphas.sum() < 0.8 * whole.sum()
    own = rara.rasterize(*arrays, np.stack([colors, 0 * colors]), viewmats, Ks, *SIZE, **options)[0]
    assert own[0].max() > 0.5 and own[1].max() == 0


def test_tensors_come_back_as_tensors(renderer, gaussians, given, monkeypatch):
    """torch is not needed: what is asked of it stands in for it."""
    arrays, (viewmats, Ks), _ = given

    class Tensor:
        __module__ = "torch"
        requires_grad = True

        def __init__(self, array):
            self.array = array

        def detach(self):
            return self.array

    monkeypatch.setitem(sys.modules, "torch", types.SimpleNamespace(from_numpy=Tensor))
    tensors = [Tensor(array) for array in (*arrays, gaussians.sh, viewmats, Ks)]
    colours, alphas, _ = rara.rasterize(*tensors, *SIZE, sh_degree=1, renderer=renderer)
    assert isinstance(colours, Tensor) and isinstance(alphas, Tensor)
    assert colours.array.shape == (2, 48, 64, 3)


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"viewmats": np.eye(4)}, r"viewmats is an array of float64 \[4, 4\]; give float32 \[C, 4, 4\]"),
        ({"Ks": np.zeros((3, 3, 3))}, r"Ks is an array of float64 \[3, 3, 3\]; give float32 \[2, 3, 3\]"),
        ({"backgrounds": np.zeros(3)}, "backgrounds is"),
        ({"colors": np.zeros((500, 4))}, r"colors has the shape \[500, 4\]; give \[500, 3\]"),
        ({"colors": np.zeros((3, 500, 3))}, r"colors has the shape \[3, 500, 3\]"),
        ({"render_mode": "RGBD"}, "render_mode is 'RGBD'; give one of RGB, D, ED"),
        ({"rasterize_mode": "x"}, "rasterize_mode"),
        ({"camera_model": "fisheye"}, "camera_model is 'fisheye'; give pinhole or ortho"),
        ({"radius_clip": 3}, "radius_clip"),
        ({"width": 0}, "width, height: a picture of 0x48"),
        ({"width": 10**9}, "1000000000x48"),
        ({"colors": np.zeros((500, 5, 3)), "sh_degree": 2}, r"colors has the shape \[500, 5, 3\]; give .*at least 9"),
        ({"sh_degree": 7}, "sh_degree is 7; give 0 to 3"),
        ({"background": (1, 1, 1)}, "background is not an argument here"),
        ({"moode": 0}, "there is no setting 'moode'"),
    ],
)
def test_wrong_arguments_are_named(renderer, gaussians, given, changed, said):
    arrays, (viewmats, Ks), _ = given
    names = dict(zip(("means", "quats", "scales", "opacities"), arrays))
    names |= {"colors": gaussians.means, "viewmats": viewmats, "Ks": Ks, "width": 64, "height": 48}
    with pytest.raises(rara.InvalidError, match=said):
        rara.rasterize(**(names | {"renderer": renderer} | changed))
