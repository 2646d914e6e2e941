"""Pictures are those of the program."""

import logging
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest

import rara

from conftest import SIZE

CLIP = "all(plane:x=40%, not(sphere:0,0,0,0.3))"


def drawn(program, path, scene, *flags):
    program("render", scene, "-o", path, "--size", "64x48", "--quiet", *flags)
    return rara.Picture.load(path)


@pytest.fixture(scope="module")
def file(tmp_path_factory, gaussians):
    path = tmp_path_factory.mktemp("scene") / "scene.ply"
    gaussians.save(path)
    return path


def test_cameras_and_pictures_are_those_of_the_program(program, renderer, file, tmp_path):
    flags = ("--eye", "1,-1,-3", "--target", "0,0.1,0", "--fov-y", "40", "--save-camera", tmp_path / "camera.json")
    expected = drawn(program, tmp_path / "a.exr", file, "--clip-expr", CLIP, *flags)
    camera = rara.Camera.look_at((1, -1, -3), (0, 0.1, 0), fov_y=40, size=SIZE)
    assert camera == rara.Camera.load(tmp_path / "camera.json")
    same = rara.Camera.from_matrices(camera.viewmat, camera.K, *camera.size)
    np.testing.assert_allclose(same.viewmat, camera.viewmat, atol=1e-12)
    picture = renderer.render(rara.load(file), camera, CLIP)
    np.testing.assert_array_equal(picture.array, expected.array)
    camera.save(tmp_path / "saved.json")
    assert rara.Camera.load(tmp_path / "saved.json") == camera


def test_settings_are_those_of_the_program(program, renderer, file, tmp_path):
    expected = drawn(program, tmp_path / "a.exr", file, "--clip", "plane:x=40%", "--mode", "rara", "--sigma", "2.5")
    picture = renderer.render(rara.load(file), clip="plane:x=40%", size=SIZE, mode="rara", sigma=2.5)
    np.testing.assert_array_equal(picture.array, expected.array)


def test_png_files_have_the_bytes_of_the_program(program, renderer, file, tmp_path):
    drawn(program, tmp_path / "a.png", file, "--clip-expr", CLIP, "--background", "1,0.5,0", "--mode", "hard")
    picture = renderer.render(rara.load(file), clip=CLIP, size=SIZE, background=(1, 0.5, 0), mode="hard")
    assert picture._repr_png_() == (tmp_path / "a.png").read_bytes()
    picture.save(tmp_path / "b.png")
    assert (tmp_path / "b.png").read_bytes() == picture._repr_png_()


def test_clips_combine_as_their_texts_do(renderer, gaussians):
    clip = rara.Plane((1, 0, 0), 0.1) & ~rara.Sphere((0, 0, 0), 0.1)
    text = "all(plane:1,0,0,0.1, !sphere:0,0,0,0.1)"
    assert clip == rara.Clip(text)
    picture = renderer.render(gaussians, clip=clip, size=SIZE)
    np.testing.assert_array_equal(picture.array, renderer.render(gaussians, clip=text, size=SIZE).array)
    assert list(clip.keeps([[0, 0, 0], [0.5, 0, 0], [-0.5, 0, 0]])) == [False, True, False]
    assert str(rara.Box((0, 0, 0), (1, 2, 3)) | clip) == "any(box:0,0,0,1,2,3, " + str(clip) + ")"
    assert str(clip & "slab:0,0,1,0,1") == str(rara.Clip.all([clip, "slab:0,0,1,0,1"]))
    assert ("slab:0,0,1,0,1" | clip) == rara.Clip(f"any(slab:0,0,1,0,1, {clip})")
    assert isinstance(rara.Sphere((0, 0, 0), 1), rara.Clip)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: rara.Sphere((1, 2), 3), r"centre is \(1, 2\); give 3 finite numbers"),
        (lambda: rara.Sphere((0, 0, 0), np.nan), "radius is nan; give a finite number"),
        (lambda: rara.Polygon("z;0,0", [[0, 0]]), "axis is 'z;0,0'"),
        (lambda: rara.Polygon("z", np.zeros((3, 3))), r"corners has the shape \[3, 3\]; give \[N, 2\]"),
        (lambda: rara.Sphere((0, 0, 0), 1) & "sphear:1", "clip: column 1"),
        (lambda: rara.Plane((0, 0, 1)).between("plane:0,0,1,1", 2), "share is 2"),
        (lambda: rara.Layer("a", rara.generate("general", 1), position=(0, 0)), r"position is \(0, 0\); give 3"),
        (lambda: rara.section(rara.generate("general", 1), "x", 1.5), "at is 1.5"),
        (lambda: rara.Picture(np.zeros((2, 2, 4), np.uint8)), "pixels is an array of integers"),
    ],
)
def test_wrong_parts_are_named(make, said):
    with pytest.raises(rara.InvalidError, match=said):
        make()


def test_a_mesh_keeps_its_inside(tmp_path):
    corners = "v 0 0 1\nv 0.9 0 -0.5\nv -0.5 0.8 -0.5\nv -0.5 -0.8 -0.5\n"
    (tmp_path / "cutter.obj").write_text(corners + "f 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n")
    clip = ~rara.Mesh(tmp_path / "cutter.obj", scale=2, position=(0, 0, 1))
    assert list(clip.keeps([[0, 0, 1], [0, 0, 2.9], [0, 0, 3.1]])) == [False, False, True]
    (tmp_path / "open.obj").write_text(corners + "f 1 2 3\nf 1 3 4\nf 1 4 2\n")
    with pytest.raises(rara.Error, match="is not closed"):
        rara.Mesh(tmp_path / "open.obj")
    assert rara.Mesh(tmp_path / "open.obj", winding=True).keeps([[0, 0, 0]]) == [True]
    # What was read stays, whatever becomes of the file, and any name is one.
    (tmp_path / "cutter.obj").rename(tmp_path / "a, (1);scale=3.obj")
    both = clip & "plane:0,0,1,-3" & ~clip | rara.Sphere((0, 0, 9), 1)
    assert list(both.keeps([[0, 0, 9], [0, 0, 3.1]])) == [True, False]
    assert rara.Mesh(tmp_path / "a, (1);scale=3.obj").keeps([[0, 0, 0.9]]) == [True]
    with pytest.raises(rara.IoError) as failed:
        rara.Mesh(tmp_path / "cutter.obj")
    assert failed.value.filename == str(tmp_path / "cutter.obj") and failed.value.errno == 2
    deep = rara.Sphere((0, 0, 0), 1)
    with pytest.raises(rara.InvalidError, match="deeper"):
        for _ in range(30):
            deep = (deep & "plane:0,0,1,0") | "sphere:0,0,0,1"


def test_clips_keep_to_their_files(tmp_path, gaussians):
    clip = rara.Clip("plane:z=25%") | rara.Cone((0, 0, 0), (0, 0, 1), 0.5)
    with pytest.raises(rara.InvalidError, match="scene is missing"):
        clip.save(tmp_path / "clip.json")
    clip.save(tmp_path / "clip.json", gaussians)
    again = rara.Clip.load(tmp_path / "clip.json")
    points = np.random.default_rng(2).standard_normal((50, 3))
    np.testing.assert_array_equal(again.keeps(points), clip.keeps(points, gaussians))


def test_layers_are_drawn_without_uploading_them_again(renderer, gaussians):
    scene = rara.Scene([rara.Layer("half", gaussians, position=(0.2, 0, 0), opacity=0.5), gaussians])
    camera = rara.Camera.frame(scene, SIZE)
    picture = renderer.render(scene, camera)
    np.testing.assert_array_equal(renderer.render(scene, size=SIZE).array, picture.array)
    hidden = scene.replace("half", visible=False)
    assert not np.array_equal(renderer.render(hidden, camera).array, picture.array)
    cut = scene.replace("half", clip=rara.Plane((1, 0, 0)))
    changed = renderer.render(cut, camera)
    renderer.render(gaussians, size=SIZE)  # so that it is uploaded once more
    np.testing.assert_array_equal(renderer.render(cut, camera).array, changed.array)
    with pytest.raises(KeyError, match="nobody"):
        scene["nobody"]
    with pytest.raises(rara.InvalidError, match="opacity of layer 'half' is 2"):
        renderer.render(scene.replace("half", opacity=2))


def test_pictures_are_arrays(renderer, gaussians):
    picture = renderer.render(gaussians, size=SIZE)
    array = np.asarray(picture)
    assert array.dtype == np.float32 and array.shape == (48, 64, 4)
    assert not array.flags.owndata
    straight = picture.rgba8()
    alpha = array[..., 3:]
    colours = np.divide(array[..., :3], alpha, where=alpha > 0, out=np.zeros_like(array[..., :3]))
    assert np.abs(straight[..., :3] - 255 * colours.clip(0, 1)).max() <= 0.51
    same = rara.Picture(array)
    assert rara.compare(picture, same)["psnr"] is None
    assert rara.compare(picture, 1 - array)["l1"] > 1
    assert picture.stats["counts"]["drawn"] > 0 and same.stats is None


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"mode": "none at all"}, "mode 'none at all'"),
        ({"moode": "exact"}, "there is no setting 'moode'"),
        ({"clip": "sphear:1"}, "clip: column 1"),
        ({"clip": 3}, "clip is a .*int.*give a rara.Clip"),
        ({"camera": "plane:z=40%"}, "camera is a .*str.*a clip by clip="),
        ({"size": (-1, 10)}, "size is .*-1, 10.*; give a width and a height"),
        ({"size": (0, 10)}, "0x10"),
        ({"size": (10**6, 10**6)}, "1000000x1000000"),
        ({"background": (1, 2)}, "background"),
        ({"sigma": float("nan")}, "sigma"),
    ],
)
def test_wrong_arguments_are_named(renderer, gaussians, arguments, said):
    with pytest.raises(rara.InvalidError, match=said):
        renderer.render(gaussians, **arguments)


def test_wrong_scenes_and_devices_are_named(renderer, gaussians):
    with pytest.raises(rara.InvalidError, match="turns is NaN"):
        rara.orbit(gaussians, 3, turns=float("nan"))
    with pytest.raises(rara.InvalidError, match="thickness is -1"):
        rara.section(gaussians, "axial", 0.5, thickness=-1)
    with pytest.raises(rara.InvalidError, match="scene is a .*int"):
        renderer.render(3)
    with pytest.raises(rara.InvalidError, match="K is"):
        rara.Camera.from_matrices(np.eye(4), 2 * np.eye(3), 4, 4)
    with pytest.raises(rara.DeviceError, match="nothing-like-it"):
        rara.Renderer("nothing-like-it")
    assert any(name == renderer.device for name, _, problem in rara.devices() if problem is None)


def test_a_thousand_pictures_leak_nothing(renderer, gaussians):
    def draw(count):
        for number in range(count):
            renderer.render(gaussians, clip=f"plane:1,0,0,{number % 50 / 50 - 0.5}", size=(32, 24))
        return renderer.device_bytes, resident_bytes()

    device, resident = draw(100)
    after, resident_after = draw(900)
    assert after == device
    assert resident_after - resident < 16 << 20


def resident_bytes():
    try:
        with open("/proc/self/statm") as statm:
            return int(statm.read().split()[1]) * 4096
    except OSError:
        pytest.skip("only Linux says how much memory is in use")


def test_threads_draw_at_the_same_time(renderer, gaussians):
    expected = renderer.render(gaussians, size=SIZE)
    ticks, found = 0, []

    def draw():
        found.extend(renderer.render(gaussians, size=SIZE).array for _ in range(20))

    threads = [threading.Thread(target=draw) for _ in range(2)]
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):
        ticks += 1
    assert ticks > 1000  # Python ran meanwhile
    assert all(np.array_equal(array, expected.array) for array in found)


def test_warnings_go_to_the_log(caplog, tmp_path):
    (tmp_path / "cache").write_text("no folder")
    with caplog.at_level(logging.WARNING, logger="rara"):
        rara.Renderer(cache=str(tmp_path / "cache")).render(rara.generate("general", 5), size=(8, 8))
    assert all(record.name == "rara" for record in caplog.records)


def test_channels_and_picks_belong_to_the_picture(renderer, gaussians):
    camera = rara.Camera.frame(gaussians, SIZE)
    alpha = renderer.render(gaussians, camera).array[..., 3]
    channels = renderer.channels(gaussians, camera)
    assert list(channels) == ["depth", "normal", "layer", "weight", "count"]
    assert channels["normal"].shape == (48, 64, 3)
    np.testing.assert_array_equal(channels["layer"] == 0, alpha > 0)
    np.testing.assert_array_equal(channels["count"] > 0, alpha > 0)
    picked = renderer.pick(gaussians, (10, 10, 20, 15), camera)
    assert picked["number"].shape == (15, 20) and picked["number"].max() < len(gaussians)
    np.testing.assert_array_equal(picked["layer"] == 0, picked["alpha"] > 0)
    with pytest.raises(rara.InvalidError, match="names"):
        renderer.channels(gaussians, camera, names=["depths"])


def test_several_pictures_are_drawn_ahead(renderer, gaussians):
    cameras = rara.orbit(gaussians, 4, size=(32, 24))
    pictures = list(renderer.pictures(gaussians, cameras, clip="plane:1,0,0,0"))
    for camera, picture in zip(cameras, pictures):
        again = renderer.render(gaussians, camera, "plane:1,0,0,0")
        np.testing.assert_array_equal(again.array, picture.array)
    assert len(rara.path(cameras, 5, closed=True)) == 5
    first = next(renderer.pictures(gaussians, cameras))  # and no more of them
    assert first.size == (32, 24)
    with pytest.raises(rara.InvalidError, match="step by step"):
        rara.sweep("plane:1,0,0,0", "sphere:0,0,0,1", 3)
    sweep = rara.sweep("plane:x=0%", "plane:x=100%", 3, gaussians)
    light = [picture.array.sum() for picture in renderer.pictures(gaussians, sweep, cameras[0])]
    assert light[0] > light[1] > light[2]
    with pytest.raises(rara.OutOfMemoryError, match="cameras"):
        rara.orbit(gaussians, 2**32 - 1, turns=1)


def test_sections_and_slices_are_those_of_the_program(program, renderer, file, tmp_path):
    scene = rara.load(file)
    shot = rara.section(scene, "axial", 0.4, size=SIZE)
    expected = drawn(program, tmp_path / "a.exr", file, "--section", "axial=40%")
    picture = next(renderer.pictures(scene, [shot]))
    np.testing.assert_array_equal(picture.array, expected.array)
    expected = drawn(program, tmp_path / "b.exr", file, "--section", "axial=40%", "--slice")
    np.testing.assert_array_equal(renderer.slice(scene, shot).array, expected.array)
    assert renderer.slice(scene, shot, background=(1, 0, 0)).array[..., 3].min() == 1


def test_panoramas_are_those_of_the_program(program, renderer, file, tmp_path):
    program("render", file, "-o", tmp_path / "a.exr", "--panorama", "--size", "64x32", "--eye", "0,0,0", "--quiet")
    scene = rara.load(file)
    camera = rara.Camera.look_at((0, 0, 0), (0, 0, 1))
    picture = renderer.panorama(scene, camera, width=64)
    assert picture.size == (64, 32)


def test_the_truth_is_near(renderer, gaussians):
    picture = renderer.render(gaussians, clip=CLIP, size=SIZE)
    truth = rara.truth(gaussians, clip=CLIP, size=SIZE)
    assert 0 < rara.compare(picture, truth)["max"] < 1


@pytest.mark.skipif(not hasattr(signal, "SIGINT") or sys.platform == "win32", reason="signals are sent as on Unix")
def test_ctrl_c_ends_a_loop_of_pictures():
    # Programs that are begun in the background of a shell's script ignore Ctrl-C unless they say otherwise.
    code = """
import itertools, rara, signal
signal.signal(signal.SIGINT, signal.default_int_handler)
scene = rara.generate("general", 500)
shots = (f"plane:1,0,0,{n % 7 / 7}" for n in itertools.count())
for picture in rara.Renderer().pictures(scene, shots, size=(32, 24), mode="hard"):
    print("drawn", flush=True)
"""
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "drawn\n"
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
    assert errors.rstrip().endswith("KeyboardInterrupt") and process.returncode != 0
