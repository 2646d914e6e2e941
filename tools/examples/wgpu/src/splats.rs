//! rara's part: a scene that comes through wgpu's own staging memory, and the frame.

use rara::ash::vk;
use rara::gpu::{Bindings, WriteOnly};
use rara::{
    Camera, Clip, Cut, DepthDesc, DepthMap, Gaussians, PreparedFrame, Renderer, RendererDesc,
    SceneBuffers, Settings, ShFormat, Staging,
};
use wgpu::hal::api::Vulkan;

use crate::Failure;
use crate::host::Host;
use crate::meshes::Meshes;
use crate::target::Target;

/// Frames that the host records before it waits for the oldest.
const FRAMES: u32 = 2;

/// What rara draws of a scene.
pub(crate) struct View {
    pub(crate) camera: Camera,
    /// What the host's depth buffer holds.
    pub(crate) depth: DepthMap,
    pub(crate) clip: Clip,
    pub(crate) settings: Settings,
}

/// An eye of a frame: what the host draws before it, into what, and the camera.
pub(crate) struct Eye<'a> {
    pub(crate) meshes: &'a Meshes,
    pub(crate) target: &'a Target,
    pub(crate) camera: Camera,
}

pub(crate) struct Splats {
    /// One for each eye.
    renderers: Vec<Renderer>,
    /// The Gaussians that the clip keeps are found once for all eyes.
    cut: Cut,
    scene: SceneBuffers,
    /// The submissions of the last frames, the oldest first.
    in_flight: Vec<wgpu::SubmissionIndex>,
    device: wgpu::Device,
}

/// What rara records with is freed here, which the device is done with before, whichever way the host got here.
impl Drop for Splats {
    fn drop(&mut self) {
        let last = wgpu::PollType::Wait {
            submission_index: self.in_flight.pop(),
            timeout: None,
        };
        let _ = self.device.poll(last); // of a lost device nothing runs any more
    }
}

impl Splats {
    /// Uploads a scene, and makes a renderer for each of so many eyes, into targets of a format.
    pub(crate) fn new(
        host: &Host,
        scene: &Gaussians,
        format: wgpu::TextureFormat,
        view: &View,
        eyes: usize,
    ) -> Result<Self, Failure> {
        let depth = DepthDesc::new(vk::Format::D32_SFLOAT, view.depth).readable(true);
        let desc = RendererDesc::new(vulkan(format)?)
            .depth(Some(depth))
            .bindings(Bindings::suiting(&host.rara))
            .frames_in_flight(FRAMES);
        let first = Renderer::new(&host.rara, desc)?;
        let cut = Cut::new(&first);
        let mut renderers = vec![first];
        while renderers.len() < eyes {
            renderers.push(renderers[0].sharing(desc)?);
        }
        Ok(Self {
            renderers,
            cut,
            scene: upload(host, scene)?,
            in_flight: Vec::new(),
            device: host.device.clone(),
        })
    }

    /// Draws a frame: for each eye the host's meshes, splats before and behind them, and the copy that reads the picture back. All
    /// of it is one submission. Without `careful` a transition is left out, which the validation layer has to see.
    pub(crate) fn frame(
        &mut self,
        host: &Host,
        eyes: &[Eye<'_>],
        view: &View,
        careful: bool,
    ) -> Result<(), Failure> {
        if self.in_flight.len() == FRAMES as usize {
            host.wait(Some(self.in_flight.remove(0)))?;
        }
        let (renderers, cut, scene) = (&mut self.renderers, &mut self.cut, &self.scene);
        cut.configure(scene, &view.clip, &view.settings)?;
        let mut frames = Vec::new();
        for (renderer, eye) in renderers.iter_mut().zip(eyes) {
            frames.push(renderer.configure(scene, &eye.camera, &*cut, &view.settings)?);
        }

        // 1. wgpu draws, then brings its textures to where rara wants them: colours to be drawn onto once more, for which they
        //    need a barrier although their layout stays, and depths to be copied.
        let mut encoder = encoder(host, "meshes");
        for Eye { meshes, target, .. } in eyes {
            meshes.draw(&mut encoder, target);
            let again = (&target.color, wgpu::TextureUses::COLOR_TARGET);
            let copied = careful.then_some((&target.depth, wgpu::TextureUses::COPY_SRC));
            transition(&mut encoder, [again].into_iter().chain(copied));
        }
        let drawn = encoder.finish();

        // 2. rara's stages, outside any scope.
        let (prepared, stages) = host.raw(
            "splats' stages",
            |cmd| -> rara::Result<Vec<PreparedFrame>> {
                // SAFETY: `cmd` is recording outside any scope, and all is kept until the frame has executed.
                unsafe { cut.prepare(cmd) }?;
                let of_eyes = renderers.iter_mut().zip(eyes).zip(frames);
                let prepared = of_eyes.map(|((renderer, eye), frame)| {
                    // SAFETY: as above; wgpu has made the depths visible to copies.
                    unsafe { renderer.prepare(cmd, scene, Some(&eye.target.depth_image()), frame) }
                });
                prepared.collect()
            },
        );
        let prepared = prepared?;

        // 3. wgpu takes the depths back.
        let mut encoder = self::encoder(host, "depth");
        let depths = eyes.iter().map(|eye| &eye.target.depth);
        let tested = depths.map(|depth| (depth, wgpu::TextureUses::DEPTH_STENCIL_WRITE));
        transition(&mut encoder, tested);
        let back = encoder.finish();

        // 4. The splats, in a scope of Vulkan's over wgpu's textures. They stay as wgpu knows them.
        let (shown, splats) = host.raw("splats", |cmd| {
            let of_eyes = renderers.iter_mut().zip(eyes).zip(&prepared);
            let drawn = of_eyes.map(|((renderer, eye), frame)| {
                // SAFETY: as above; the scope's attachments are of the renderer's formats.
                unsafe {
                    eye.target.begin(host, cmd);
                    let drawn = renderer.draw(cmd, [0.0, 0.0], frame);
                    host.rara.raw().cmd_end_rendering(cmd);
                    drawn
                }
            });
            drawn.collect::<rara::Result<()>>()
        });
        shown?;

        // 5. wgpu goes on, here with a copy.
        let mut encoder = self::encoder(host, "read back");
        for eye in eyes {
            eye.target.read_back(&mut encoder);
        }
        let commands = [drawn, stages, back, splats, encoder.finish()];
        self.in_flight.push(host.queue.submit(commands));
        Ok(())
    }

    /// How the last frame's splats became pixels.
    pub(crate) fn path(&self) -> &'static str {
        self.renderers[0].raster().path
    }
}

/// Uploads a scene through a buffer that wgpu maps for writing alone, without waiting for anything but the end.
fn upload(host: &Host, scene: &Gaussians) -> Result<SceneBuffers, Failure> {
    let size = SceneBuffers::staging_bytes(scene, ShFormat::Float);
    let buffer = host.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("splats' staging"),
        size: size.next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT),
        usage: wgpu::BufferUsages::MAP_WRITE | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: true,
    });
    let mut mapped = buffer.get_mapped_range_mut(..)?;
    let mut bytes = mapped.slice(..);
    let (uploaded, commands) = host.raw("upload", |cmd| {
        // SAFETY: nothing of what is shown is destroyed. What wgpu maps can be written and is nobody else's while the view is
        // there; `cmd` is recording outside any scope, and scene and buffer are kept until it has executed.
        unsafe {
            let hal = buffer.as_hal::<Vulkan>().expect("a buffer of Vulkan's");
            let staging = Staging {
                buffer: hal.raw_handle(),
                offset: 0,
                bytes: WriteOnly::new(bytes.as_raw_ptr()),
            };
            SceneBuffers::upload_with(&host.rara, cmd, staging, scene, ShFormat::Float)
        }
    });
    drop(mapped);
    buffer.unmap(); // before the submission: this makes what was written visible to it
    let uploaded = uploaded?;
    host.wait(Some(host.queue.submit([commands])))?; // the buffer could be kept for a frame instead
    Ok(uploaded)
}

fn encoder(host: &Host, label: &str) -> wgpu::CommandEncoder {
    let desc = wgpu::CommandEncoderDescriptor { label: Some(label) };
    host.device.create_command_encoder(&desc)
}

/// Has wgpu record the barriers that bring textures to uses, which it remembers.
fn transition<'a>(
    encoder: &mut wgpu::CommandEncoder,
    uses: impl IntoIterator<Item = (&'a wgpu::Texture, wgpu::TextureUses)>,
) {
    let transition = |(texture, state)| wgpu::TextureTransition {
        texture,
        selector: None,
        state,
    };
    let textures = uses.into_iter().map(transition);
    encoder.transition_resources(std::iter::empty(), textures);
}

/// The Vulkan format of a target's.
fn vulkan(format: wgpu::TextureFormat) -> Result<vk::Format, Failure> {
    match format {
        wgpu::TextureFormat::Rgba8Unorm => Ok(vk::Format::R8G8B8A8_UNORM),
        wgpu::TextureFormat::Rgba16Float => Ok(vk::Format::R16G16B16A16_SFLOAT),
        other => Err(format!("the example has no targets of {other:?}").into()),
    }
}
