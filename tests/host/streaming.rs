//! Scenes are replaced and clips edited while frames are in flight, with the host's own staging and without a submission
//! or wait of ours, under the host's validation with synchronisation checks. The pictures are the headless ones.

use crate::canvas::adopt;
use crate::canvas::host::{FRAMES, Host, HostDesc};
use crate::common;
use rara::ash::vk;
use rara::scene::{Kind, generate};
use rara::{
    Clip, ClipOp, ConfiguredFrame, Cut, Gaussians, Layer, Picture, Raster, Renderer, RendererDesc,
    Scene, SceneBuffers, Settings, ShFormat, Show, Staging,
};
use rara_gpu::{Bindings, Buffer, BufferDesc, Device, Location};

pub(super) const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
pub(super) const VIEW: vk::Extent2D = vk::Extent2D {
    width: 121,
    height: 83,
};
const STAY: usize = 4;

/// A host, and its device adopted by rara.
pub(super) fn open(validation: bool) -> (Host, Device) {
    let host = Host::new(&HostDesc {
        device: std::env::var("RARA_TEST_DEVICE").ok().as_deref(),
        validation,
        optional: true,
        extent: VIEW,
        format: FORMAT,
    });
    let host = host.expect("a Vulkan device and the validation layer (tools/test installs both)");
    let device = adopt(&host);
    (host, device)
}

/// Records the rest of a frame that is configured.
pub(super) fn record(
    host: &mut Host,
    renderer: &mut Renderer,
    cmd: vk::CommandBuffer,
    scene: &SceneBuffers,
    frame: rara::Result<ConfiguredFrame>,
) {
    let frame = frame.expect("configures");
    // SAFETY: `cmd` is recording outside rendering, and every test keeps scenes until their frames are done.
    let frame = unsafe { renderer.prepare(cmd, scene, None, frame) }.expect("prepares");
    host.begin_rendering(VIEW.into());
    // SAFETY: `cmd` is inside rendering to a target of the renderer's format.
    unsafe { renderer.draw(cmd, [0.0, 0.0], &frame) }.expect("draws");
    host.submit().expect("submits");
}

/// Allocates a scene, and records its copies into a frame's own commands.
fn upload(device: &Device, cmd: vk::CommandBuffer, scene: &Gaussians) -> (SceneBuffers, Buffer) {
    let desc = BufferDesc {
        name: "host's staging",
        size: SceneBuffers::staging_bytes(scene, ShFormat::Packed),
        location: Location::Upload,
    };
    let mut memory = device.create_buffer(&desc).expect("a buffer");
    let staging = Staging {
        buffer: memory.handle(),
        offset: 0,
        bytes: memory.mapped_mut(),
    };
    // SAFETY: `cmd` is recording outside rendering; scene and memory are kept until the frame is done.
    let uploaded =
        unsafe { SceneBuffers::upload_with(device, cmd, staging, scene, ShFormat::Packed) };
    (uploaded.expect("uploads"), memory)
}

/// A clip that moves with each frame and has another number of planes in each stay.
fn clip(scene: &Gaussians, frame: usize) -> Clip {
    let clip = common::clip(scene, 1 + frame / STAY, ClipOp::And);
    common::moved(clip, 0.05 * (frame % STAY) as f64)
}

fn check(what: &str, host: &Host, pixels: &[[f32; 4]], truth: &Picture) {
    let expected = truth.pixels.iter().enumerate().map(|(i, pixel)| {
        let below = host.backdrop(i as u32 % truth.width);
        [0, 1, 2, 3].map(|c| (pixel[c] + (1.0 - pixel[3]) * below[c]).clamp(0.0, 1.0))
    });
    let differences = pixels.iter().zip(expected).flat_map(|(ours, theirs)| {
        let c = |i: usize| (ours[i].clamp(0.0, 1.0) - theirs[i]).abs();
        [c(0), c(1), c(2), c(3)]
    });
    let worst = differences.fold(0.0, f32::max);
    assert!(worst < 1.0 / 255.0, "{what}: {worst}");
}

#[test]
fn scenes_and_clips_change_while_frames_are_in_flight() {
    let scenes = [
        generate(Kind::General, 2_000, 5),
        generate(Kind::Strands, 900, 6),
        generate(Kind::Layers, 3_500, 7),
    ];
    let frames = scenes.len() * STAY;
    let cameras: Vec<_> = scenes
        .iter()
        .map(|scene| common::views(scene, 1, (VIEW.width, VIEW.height))[0])
        .collect();
    let mut headless = common::headless();
    let mut truth = Vec::new();
    for frame in 0..frames {
        let at = frame / STAY;
        if frame % STAY == 0 {
            let loaded = headless.load_as(&scenes[at], ShFormat::Packed);
            loaded.expect("uploads");
        }
        headless.forget();
        let drawn = headless.render(
            &cameras[at],
            &clip(&scenes[at], frame),
            &Settings::default(),
        );
        drawn.expect("renders");
        truth.push(headless.picture().expect("reads back"));
    }

    // A new scene's copies are in the commands of the frame that first shows it, or in those of the frame before.
    let ways = [
        (Raster::Tiles, Bindings::Mixed, true, 0),
        (Raster::Tiles, Bindings::Address, false, 1),
        (Raster::Quad, Bindings::Mixed, false, 1),
        (Raster::Quad, Bindings::Address, true, 0),
    ];
    for (raster, bindings, reuse, ahead) in ways {
        let (mut host, device) = open(true);
        let desc = RendererDesc::new(FORMAT)
            .bindings(bindings)
            .reuse(reuse)
            .frames_in_flight(FRAMES as u32);
        let mut renderer = Renderer::new(&device, desc).expect("a renderer");
        // The scene that is shown, the next one, and those that frames in flight may still use.
        let mut current: Option<(SceneBuffers, Buffer)> = None;
        let mut coming = None;
        let mut retired: Vec<(usize, (SceneBuffers, Buffer))> = Vec::new();
        for frame in 0..frames {
            if let Some(pixels) = host.wait().expect("waits") {
                let what = format!("{raster:?}, {bindings:?}, frame {}", frame - FRAMES);
                check(&what, &host, &pixels, &truth[frame - FRAMES]);
                retired.retain(|(last, _)| *last > frame - FRAMES);
            }
            let at = frame / STAY;
            let cmd = host.begin().expect("begins");
            let next = (frame + ahead) / STAY;
            if ahead == 1 && next < scenes.len() && (frame + ahead) % STAY == 0 {
                coming = Some(upload(&device, cmd, &scenes[next]));
            }
            if frame % STAY == 0 {
                let fresh = coming.take().filter(|_| frame > 0 && ahead == 1);
                let fresh = fresh.unwrap_or_else(|| upload(&device, cmd, &scenes[at]));
                retired.extend(current.replace(fresh).map(|old| (frame - 1, old)));
            }
            let (scene, _) = current.as_ref().expect("uploaded");
            let settings = Settings::default().raster(raster);
            let configured =
                renderer.configure(scene, &cameras[at], &clip(&scenes[at], frame), &settings);
            record(&mut host, &mut renderer, cmd, scene, configured);
        }
        let pixels = host.wait_for_all().expect("waits");
        check("the last frame", &host, &pixels, &truth[frames - 1]);
        drop((renderer, current, coming, retired));
        assert_eq!(device.device_bytes(), 0, "everything allocated was freed");
        drop(device);
        assert_eq!(host.close(), Vec::<String>::new());
    }
}

pub(super) fn layers(parts: [&Gaussians; 3]) -> Scene<'_> {
    parts
        .map(|part| Layer::new("part", part))
        .into_iter()
        .collect()
}

/// The memory that a host stages a layer in.
pub(super) fn lend(device: &Device, size: u64) -> Buffer {
    let desc = BufferDesc {
        name: "host's staging",
        size: size.max(1),
        location: Location::Upload,
    };
    device.create_buffer(&desc).expect("a buffer")
}

/// A layer of a scene gets other Gaussians in each frame, while the frame before is in flight; the pictures are, to the byte,
/// those of scenes that were uploaded as a whole.
#[test]
fn a_layer_is_replaced_while_frames_are_in_flight() {
    let first = generate(Kind::General, 700, 1);
    let last = generate(Kind::Layers, 900, 3);
    // As many as there is room for, fewer, few, none, and again many.
    let middles = [1_500, 1_100, 3, 0, 700, 1_500].map(|count| generate(Kind::Strands, count, 2));
    let camera = common::views(&first, 1, (VIEW.width, VIEW.height))[0];
    let clip = common::clip(&first, 1, ClipOp::And);
    let settings =
        |at: usize| Settings::default().raster([Raster::Tiles, Raster::Quad][at / 2 % 2]);
    let (mut host, device) = open(true);
    let frames = middles.len();
    let [mut pictures, mut truth] = [Vec::new(), Vec::new()];
    for is_whole in [false, true] {
        let desc = RendererDesc::new(FORMAT)
            .reuse(!is_whole)
            .frames_in_flight(FRAMES as u32);
        let mut renderer = Renderer::new(&device, desc).expect("a renderer");
        let drawn = if is_whole { &mut truth } else { &mut pictures };
        let upload = |middle| {
            let scene = layers([&first, middle, &last]);
            SceneBuffers::upload(&device, scene, ShFormat::Packed).expect("uploads")
        };
        let mut replaced = upload(&middles[0]);
        let mut kept = Vec::new();
        for (at, middle) in middles.iter().enumerate() {
            // The first ones have nothing of this renderer to wait for.
            let pixels = host.wait().expect("waits");
            drawn.extend(pixels.filter(|_| at >= FRAMES));
            let whole = is_whole.then(|| upload(middle));
            let cmd = host.begin().expect("begins");
            if whole.is_none() && at > 0 {
                let size = replaced.layer_staging_bytes(1, middle.len() as u32);
                let mut memory = lend(&device, size);
                let staging = Staging {
                    buffer: memory.handle(),
                    offset: 0,
                    bytes: memory.mapped_mut(),
                };
                // SAFETY: `cmd` is recording outside rendering; memory is kept until all is waited for.
                let done = unsafe { replaced.replace_layer_with(cmd, staging, 1, middle) };
                done.expect("there is room");
                kept.push((None, Some(memory)));
            }
            let scene = whole.as_ref().unwrap_or(&replaced);
            let settings = settings(at);
            let configured = renderer.configure(scene, &camera, &clip, &settings);
            record(&mut host, &mut renderer, cmd, scene, configured);
            kept.push((whole, None));
        }
        drawn.push(host.wait_for_all().expect("waits"));
        // What wait_for_all returns is the last one.
        assert_eq!(drawn.len(), frames - FRAMES + 1);
        drop((renderer, replaced, kept));
    }
    for (at, (picture, truth)) in pictures.iter().zip(&truth).enumerate() {
        assert!(picture == truth, "frame {at}");
    }
    assert!(pictures[0] != pictures[1], "a layer changes the picture");
    drop(device);
    assert_eq!(host.close(), Vec::<String>::new());
}

/// Layers that were uploaded empty with room come and go; the pictures are, to the byte, those of scenes that were uploaded with
/// what is there, and numbers stay what they are.
#[test]
fn layers_come_and_go() {
    const ROOMS: [u32; 4] = [0, 1_500, 900, 300];
    let parts = [300, 1_500, 700, 20].map(|count| generate(Kind::Strands, count, count as u64));
    let mut nothing = Gaussians::default();
    nothing.set_sh_degree(parts[0].sh_degree());
    let mut headless = common::headless();
    let device = headless.device().clone();
    let camera = common::views(&parts[1], 1, (VIEW.width, VIEW.height))[0];
    let clip = common::clip(&parts[1], 1, ClipOp::And);
    for raster in [Raster::Tiles, Raster::Quad] {
        let settings = Settings::default().raster(raster);
        let mut draw = |scene: SceneBuffers, settings: &Settings| {
            headless.show(scene).expect("of this device");
            let drawn = headless.render(&camera, &clip, settings);
            drawn.expect("renders");
            headless.picture().expect("reads back")
        };
        let upload = |scene: Scene<'_>| {
            SceneBuffers::upload(&device, scene, ShFormat::Byte).expect("uploads")
        };
        let with_room = [&parts[0], &nothing, &nothing, &nothing].into_iter();
        let with_room = with_room.zip(ROOMS);
        let layers = with_room.map(|(part, room)| Layer::new("part", part).with_room(room));
        let mut scene = upload(layers.collect());
        let rooms: Vec<_> = scene.layers().iter().map(|layer| layer.room()).collect();
        assert_eq!(rooms, [300, 1_500, 900, 300]);
        let mut there = [true, false, false, false];
        let mut pictures = Vec::new();
        for change in [3, 1, 2, 0, 3, 1, 0] {
            there[change] = !there[change];
            let of = |index: usize| {
                if there[index] {
                    &parts[index]
                } else {
                    &nothing
                }
            };
            let replaced = scene.replace_layer(change, of(change));
            replaced.expect("there is room");
            let whole = (0..parts.len()).filter(|index| there[*index]);
            let whole = whole.map(|index| Layer::new("part", &parts[index]));
            let ours = draw(scene.clone(), &settings);
            let whole = draw(upload(whole.collect()), &settings);
            assert!(ours == whole, "{raster:?}, {there:?}");
            pictures.push(ours);
        }
        assert!(pictures[0] != pictures[1] && pictures[1] != pictures[2]);
        let strongest = draw(scene, &Settings::default().show(Show::Strongest));
        let shown = strongest.pixels.iter().filter(|pixel| pixel[3] > 0.0);
        let mut seen = [false; 4];
        for [low, high, layer, _] in shown {
            let (number, layer) = (*low as u32 + 65536 * *high as u32, *layer as usize);
            let first: u32 = rooms[..layer].iter().sum();
            let own = first..first + parts[layer].len() as u32;
            assert!(own.contains(&number), "{number} of layer {layer}");
            seen[layer] = true;
        }
        assert_eq!(seen, there);
    }
}

/// What a layer has no place for is refused, and so is what still shows the Gaussians that were replaced.
#[test]
fn replaced_layers_have_room_and_a_kind() {
    let parts = [300, 20, 10].map(|count| generate(Kind::General, count, 1));
    let mut headless = common::headless();
    let device = headless.device().clone();
    let [one, two, three] = &parts;
    let mut scene =
        SceneBuffers::upload(&device, layers([one, two, three]), ShFormat::Float).expect("uploads");
    let before = scene.clone();
    let mut renderer = Renderer::new(&device, RendererDesc::new(FORMAT)).expect("a renderer");
    let mut cut = Cut::new(&renderer);
    let (clip, usual) = (common::clip(one, 1, ClipOp::And), Settings::default());
    cut.configure(&scene, &clip, &usual).expect("a cut");
    let mut linear = two.clone();
    let training = linear.training().linear(true);
    linear.set_training(training).expect("it can be drawn");
    for (index, gaussians, says) in [
        (1, one, "has no room for 300"),
        (3, two, "no layer 3"),
        (1, &linear, "light"),
    ] {
        let refused = scene.replace_layer(index, gaussians).expect_err(says);
        assert!(refused.to_string().contains(says), "{refused}");
    }
    assert_eq!(scene.layers()[0].room(), 300);
    scene.replace_layer(0, two).expect("there is room");
    assert_eq!(scene.layers()[0].gaussians(), 20);
    assert_eq!(scene.layers()[0].room(), 300);
    let camera = common::views(one, 1, (64, 64))[0];
    let stale = renderer.configure(&before, &camera, &clip, &usual);
    let stale = stale.expect_err("its Gaussians are gone").to_string();
    assert!(stale.contains("in a clone"), "{stale}");
    let stale = renderer.configure(&scene, &camera, &cut, &usual);
    let stale = stale.expect_err("another scene's cut").to_string();
    assert!(stale.contains("another scene"), "{stale}");
    let mut draw = |scene: SceneBuffers| {
        headless.show(scene).expect("of this device");
        headless.render(&camera, &clip, &usual).expect("renders");
        headless.picture().expect("reads back")
    };
    let ours = draw(scene);
    let whole = SceneBuffers::upload(&device, layers([two, two, three]), ShFormat::Float);
    assert!(ours == draw(whole.expect("uploads")));
}

/// Nothing leaks where the device is a host's, two frames are in flight and scenes come through its own staging memory.
#[test]
fn memory_stays_flat_over_a_thousand_frames_of_a_host() {
    let scenes = [
        generate(Kind::General, 300, 1),
        generate(Kind::Strands, 700, 1),
        generate(Kind::Layers, 500, 1),
    ];
    // No validation layer, since its records grow.
    let (mut host, device) = open(false);
    let desc = RendererDesc::new(FORMAT)
        .reuse(true)
        .frames_in_flight(FRAMES as u32);
    let mut renderer = Renderer::new(&device, desc).expect("a renderer");
    let mut current: Option<(SceneBuffers, Buffer)> = None;
    let mut retired: Vec<(usize, (SceneBuffers, Buffer))> = Vec::new();
    let stays = (1_000 / STAY) / scenes.len() * scenes.len();
    let mut taken = vec![Vec::new(); scenes.len()];
    for frame in 0..stays * STAY {
        if host.wait().expect("waits").is_some() {
            retired.retain(|(last, _)| *last > frame - FRAMES);
        }
        let (stay, at) = (frame / STAY, frame / STAY % scenes.len());
        let cmd = host.begin().expect("begins");
        if frame % STAY == 0 {
            let fresh = upload(&device, cmd, &scenes[at]);
            retired.extend(current.replace(fresh).map(|old| (frame - 1, old)));
        }
        let (scene, _) = current.as_ref().expect("uploaded");
        let camera = common::views(&scenes[at], 1, (VIEW.width, VIEW.height))[0];
        // The clips have one number of planes, so that stays can be compared.
        let cut = common::clip(&scenes[at], 2, ClipOp::And);
        let cut = common::moved(cut, 0.05 * (frame % STAY) as f64);
        let configured = renderer.configure(scene, &camera, &cut, &Settings::default());
        record(&mut host, &mut renderer, cmd, scene, configured);
        if frame % STAY == STAY - 1 && stay >= 2 * scenes.len() {
            taken[at].push(device.device_bytes());
        }
    }
    host.wait_for_all().expect("waits");
    for taken in &taken {
        assert!(
            taken.len() > 50 && taken.iter().all(|bytes| *bytes == taken[0]),
            "{taken:?}"
        );
    }
    drop((renderer, current, retired));
    assert_eq!(device.device_bytes(), 0, "everything allocated was freed");
    drop(device);
    assert_eq!(host.close(), Vec::<String>::new());
}
