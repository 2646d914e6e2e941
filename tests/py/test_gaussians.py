"""Gaussians from and to arrays and files."""

import dataclasses
import gc
import sys

import numpy as np
import pytest

import rara


def arrays(gaussians):
    return gaussians.means, gaussians.quats, gaussians.scales, gaussians.opacities, gaussians.sh


def test_arrays_come_back_to_the_bit(gaussians):
    again = rara.Gaussians(*arrays(gaussians))
    for mine, theirs in zip(arrays(again), arrays(gaussians)):
        assert mine.dtype == np.float32
        np.testing.assert_array_equal(mine, theirs)


def test_views_copy_nothing_and_keep_their_gaussians_alive(gaussians):
    made = rara.Gaussians(*arrays(gaussians))
    means = made.means
    assert not means.flags.owndata
    with pytest.raises(ValueError, match="read-only"):
        means[0] = 0
    assert means.ctypes.data == made.means.ctypes.data
    expected = means.copy()
    del made
    gc.collect()
    np.testing.assert_array_equal(means, expected)


def test_a_million_are_copied_once_each_way(renderer):
    count = 1_000_000
    random = np.random.default_rng(1)
    means = random.standard_normal((count, 3), dtype=np.float32)
    quats = np.tile(np.float32([1, 0, 0, 0]), (count, 1))
    scales = np.full((count, 3), 0.01, np.float32)
    opacities = np.full(count, 0.5, np.float32)
    colors = random.random((count, 3), dtype=np.float32)
    before = peak_bytes()
    made = rara.Gaussians(means, quats, scales, opacities, colors=colors)
    own = count * 4 * (3 + 4 + 3 + 1 + 3)
    assert peak_bytes() - before < 1.2 * own
    np.testing.assert_array_equal(made.means, means)
    np.testing.assert_allclose(made.sh[:, 0] * 0.2820948 + 0.5, colors, atol=1e-6)


def peak_bytes():
    if not sys.platform.startswith("linux"):
        pytest.skip("only Linux says how much memory is in use")
    with open("/proc/self/status") as status:
        return next(int(line.split()[1]) * 1024 for line in status if line.startswith("VmHWM"))


def test_other_arrays_are_converted(gaussians):
    class Tensor:
        """An array that only says how to become one."""

        def __init__(self, array):
            self.array = array

        def __array__(self, dtype=None, copy=None):
            return self.array

    class Capsule:
        """An array by DLPack alone."""

        def __init__(self, array):
            self.array = array

        def __dlpack__(self, **options):
            return self.array.__dlpack__(**options)

        def __dlpack_device__(self):
            return self.array.__dlpack_device__()

    means, quats, scales, opacities, sh = arrays(gaussians)
    made = rara.Gaussians(
        Tensor(means), Capsule(quats), np.asfortranarray(scales), opacities.astype(np.float64), sh[::-1][::-1]
    )
    for mine, theirs in zip(arrays(made), arrays(gaussians)):
        np.testing.assert_array_equal(mine, theirs)


def test_quaternions_are_normalised(gaussians):
    means, quats, *rest = arrays(gaussians)
    made = rara.Gaussians(means, 3 * quats, *rest)
    np.testing.assert_allclose(made.quats, quats, atol=1e-6)


@pytest.mark.parametrize(
    ("name", "wrong", "said"),
    [
        ("means", lambda a: a[:, :2], r"means has the shape \[500, 2\]; give \[N, 3\]"),
        ("means", lambda a: a.astype(complex), "means is an array of complex128; give one of float32"),
        ("means", lambda a: a.astype(object), "means is an array of object"),
        ("means", lambda a: np.where(a == a[7], np.nan, a), r"means\[7\] is .*not finite"),
        ("means", lambda a: a + np.float64(1e39), r"means\[0\] is .*not finite"),
        ("quats", lambda a: a[:9], r"quats has the shape \[9, 4\]; give \[500, 4\]"),
        ("quats", lambda a: 0 * a, r"quats\[0\] is .*give a rotation"),
        ("scales", lambda a: -a, r"scales\[0\] is .*zero or above"),
        ("opacities", lambda a: a[:, None], r"opacities has the shape \[500, 1\]; give \[500\]"),
        ("opacities", lambda a: a + 2, r"opacities\[0\] is .*between 0 and 1"),
        ("sh", lambda a: a[:, :5], "sh has K = 5 of .*; give 1, 4, 9 or 16"),
        ("sh", lambda a: [["x"]], "sh is an array of <U1"),
        ("colors", lambda a: np.where(np.arange(500)[:, None] == 7, np.nan, a), r"colors\[7\] is NaN"),
    ],
)
def test_wrong_arrays_are_named(gaussians, name, wrong, said):
    given = dict(zip(("means", "quats", "scales", "opacities", "sh"), arrays(gaussians)))
    if name == "colors":
        given["colors"] = given.pop("sh")[:, 0]
    given[name] = wrong(given[name])
    with pytest.raises(rara.InvalidError, match=said), np.errstate(over="ignore"):
        rara.Gaussians(**given)


def test_huge_counts_are_refused():
    with pytest.raises(rara.OutOfMemoryError, match="no memory for 1000000000000000 Gaussians"):
        rara.generate("general", 10**15)
    with pytest.raises(rara.InvalidError, match="kind: "):
        rara.generate("nothing", 1)


def test_files_keep_gaussians_and_properties(tmp_path, gaussians):
    labels = np.arange(len(gaussians)) % 3
    made = rara.Gaussians(*arrays(gaussians), properties={"label": labels})
    for ending in ("ply", "glb", "spz", "sog", "compressed.ply"):
        path = tmp_path / f"scene.{ending}"
        made.save(path)
        scene = rara.load(path)
        assert [layer.name for layer in scene.layers] == [f"scene.{ending}".rsplit(".", 1)[0]]
        assert len(scene[0].gaussians) == len(gaussians)
        assert (scene.report["dropped"], scene.report["repaired"]) == (0, 0)
    read = rara.load(tmp_path / "scene.ply")["scene"].gaussians
    np.testing.assert_array_equal(read.properties["label"], labels)
    np.testing.assert_array_equal(read.means, gaussians.means)
    assert len(rara.Gaussians.from_bytes((tmp_path / "scene.ply").read_bytes())) == len(gaussians)
    with pytest.raises(rara.IoError, match="nowhere.ply"):
        rara.load(tmp_path / "nowhere.ply")
    with pytest.raises(rara.FormatError):
        rara.Gaussians.from_bytes(b"no scene", name="mine")


def test_selections_become_layers(tmp_path, gaussians, renderer):
    labels = np.arange(len(gaussians)) % 3
    rara.Gaussians(*arrays(gaussians), properties={"label": labels}).save(tmp_path / "scene.ply")
    scene = rara.load(tmp_path / "scene.ply", select=["ones=label = 1"])
    assert [layer.name for layer in scene.layers] == ["scene", "ones"]
    assert set(scene["ones"].gaussians.properties["label"]) == {1}
    whole = renderer.render(rara.load(tmp_path / "scene.ply"), size=(64, 48))
    np.testing.assert_array_equal(renderer.render(scene, size=(64, 48)), whole)
    read = []
    rara.load(tmp_path / "scene.ply", progress=lambda done, total: read.append((done, total)))
    assert read[-1][0] == read[-1][1] > 0
    with pytest.raises(ZeroDivisionError):
        rara.load(tmp_path / "scene.ply", progress=lambda done, total: 1 / 0)


def test_layers_of_several_files_have_their_own_properties(tmp_path, gaussians):
    for name, first in (("one", 0), ("other", 1000)):
        labels = first + np.arange(len(gaussians))
        rara.Gaussians(*arrays(gaussians), properties={"label": labels}).save(tmp_path / f"{name}.ply")
    scene = rara.load(tmp_path / "one.ply", tmp_path / "other.ply", select=["one/faint=opacity<0.5"])
    for layer in scene:
        labels = layer.gaussians.properties["label"].astype(int)
        assert (labels >= 1000).all() == (layer.name == "other") and len(labels) == len(layer.gaussians)
        np.testing.assert_array_equal(layer.gaussians.means, gaussians.means[labels % 1000])
    assert [layer.name for layer in scene] == ["one", "faint", "other"]


def test_masks_and_transforms(gaussians):
    taken = gaussians.select("opacity<0.5")
    np.testing.assert_array_equal(taken, gaussians.opacities < 0.5)
    some = gaussians.filter(taken)
    np.testing.assert_array_equal(some.means, gaussians.means[taken])
    matrix = np.eye(4)
    matrix[:3, 3] = 1, 2, 3
    np.testing.assert_allclose(gaussians.transform(matrix).means, gaussians.means + [1, 2, 3], atol=1e-6)
    with pytest.raises(rara.InvalidError, match="predicate"):
        gaussians.select("opacity<")
    with pytest.raises(rara.InvalidError, match="mask has the shape"):
        gaussians.filter(taken[:3])
    with pytest.raises(rara.InvalidError, match="matrix"):
        gaussians.transform(np.full((4, 4), np.nan))


def test_raw_arrays_are_read_as_files_are(gaussians):
    count, rest = len(gaussians), np.zeros((len(gaussians), 3, 3), np.float32)
    scaling = np.log(gaussians.scales)
    opacity = np.log(gaussians.opacities / (1 - gaussians.opacities))[:, None]
    means = gaussians.means.copy()
    means[7] = np.nan
    made = rara.from_3dgs(means, gaussians.sh[:, :1], rest, scaling, 2 * gaussians.quats, opacity)
    assert len(made) == count - 1 and made.report["dropped"] == 1
    assert "element 7" in made.report["notes"][0]
    np.testing.assert_allclose(made.scales, np.delete(gaussians.scales, 7, 0), rtol=1e-5)
    np.testing.assert_allclose(made.opacities, np.delete(gaussians.opacities, 7), rtol=1e-5)
    assert made.sh.shape == (count - 1, 4, 3)
    with pytest.raises(rara.InvalidError, match="scaling is an array of float32"):
        rara.from_3dgs(means, gaussians.sh[:, :1], None, scaling[:, :2], gaussians.quats, opacity)


def test_baking_keeps_properties(gaussians, renderer):
    labelled = rara.Gaussians(*arrays(gaussians), properties={"number": np.arange(len(gaussians))})
    scene, counts = rara.bake(labelled, "plane:1,0,0,0")
    baked = scene[0].gaussians
    assert len(baked) == counts["visible"] + counts["left"] + counts["children"] < len(gaussians)
    assert len(baked.properties["number"]) == len(baked)
    with pytest.raises(rara.InvalidError, match="'own' has a clip of its own"):
        rara.Scene([rara.Layer("own", labelled, clip="plane:0,1,0,0")]).merged()
    layers = rara.Scene([rara.Layer("own", labelled, (0.1, 0, 0), clip="plane:0,1,0,0"), rara.Layer("whole", labelled, clip="whole")])
    scene, _ = rara.bake(layers, "plane:1,0,0,0")
    assert [layer.clip for layer in scene] == [None, None] and scene[0].position == (0.1, 0, 0)
    assert scene[1].gaussians.means.shape == labelled.means.shape
    once, _ = rara.bake(dataclasses.replace(layers["own"], position=(0, 0, 0), clip=None), "plane:0,1,0,0")
    np.testing.assert_array_equal(scene[0].gaussians.opacities, once[0].gaussians.opacities)


def test_a_scene_is_saved_as_one_set(gaussians, tmp_path):
    labelled = rara.Gaussians(*arrays(gaussians), properties={"number": np.arange(len(gaussians))})
    moved = rara.Layer("moved", labelled, (1, 2, 3), opacity=0.5)
    scene = rara.Scene([gaussians, moved, rara.Layer("hidden", gaussians, visible=False)], up=(0, 0, 1))
    scene.save(tmp_path / "all.ply")
    read = rara.load(tmp_path / "all.ply")
    assert read.up == [0, 0, 1] and not read[0].gaussians.properties
    np.testing.assert_allclose(read[0].gaussians.means, np.concatenate([gaussians.means, gaussians.means + [1, 2, 3]]), atol=1e-6)
    np.testing.assert_allclose(read[0].gaussians.opacities, np.concatenate([gaussians.opacities, gaussians.opacities / 2]), atol=1e-6)
    np.testing.assert_array_equal(rara.Scene([moved]).merged().properties["number"], labelled.properties["number"])
    antialiased = rara.Gaussians(*arrays(gaussians), antialiased=True)
    with pytest.raises(rara.InvalidError, match="'0' and '1' were trained differently"):
        rara.Scene([gaussians, antialiased]).save(tmp_path / "both.ply")
