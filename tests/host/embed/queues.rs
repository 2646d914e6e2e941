//! A host that prepares frames in one submission and draws them in another, ordered by semaphores alone, as with two queues.

use super::frames::sweep;
use super::*;
use rara_gpu::faults::{self, Pretence};

/// The host's submissions for compute. Its own submissions draw.
struct Compute {
    raw: rara::ash::Device,
    queue: vk::Queue,
    slots: Vec<(vk::CommandPool, vk::CommandBuffer)>,
    /// Signalled when a frame is prepared, and when it is drawn.
    semaphores: [vk::Semaphore; 2],
    submitted: usize,
}

impl Compute {
    fn new(host: &Host) -> Self {
        let lent = host.lend();
        let raw = lent.device;
        let pool = vk::CommandPoolCreateInfo::default().queue_family_index(lent.queue_family);
        let slot = |_| {
            // SAFETY: the host's device is alive, and the pool is new.
            unsafe {
                let pool = raw.create_command_pool(&pool, None).expect("a pool");
                let info = vk::CommandBufferAllocateInfo::default()
                    .command_pool(pool)
                    .command_buffer_count(1);
                let cmds = raw.allocate_command_buffers(&info);
                (pool, cmds.expect("a command buffer")[0])
            }
        };
        // SAFETY: the host's device is alive.
        let semaphore = || unsafe { raw.create_semaphore(&Default::default(), None) };
        Self {
            slots: (0..FRAMES).map(slot).collect(),
            semaphores: [(); 2].map(|()| semaphore().expect("a semaphore")),
            queue: lent.queue,
            submitted: 0,
            raw,
        }
    }

    /// Prepares the frame that is configured, and draws it in a submission of its own.
    fn frame(&mut self, engine: &mut Engine) {
        let (pool, cmd) = self.slots[self.submitted % FRAMES];
        let begin = vk::CommandBufferBeginInfo::default();
        // SAFETY: the host has waited for the draw of the slot's last frame, which came after that frame's commands.
        unsafe {
            let flags = vk::CommandPoolResetFlags::empty();
            self.raw.reset_command_pool(pool, flags).expect("resets");
            self.raw.begin_command_buffer(cmd, &begin).expect("begins");
        }
        engine.prepare_in(cmd);
        // SAFETY: it is recording.
        unsafe { self.raw.end_command_buffer(cmd) }.expect("ends");
        let [prepared, drawn] = self.semaphores;
        let awaited = (self.submitted > 0).then_some(drawn);
        self.submit(awaited, Some(cmd), Some(prepared));
        self.submit(Some(prepared), None, None);
        let cmd = engine.host.begin().expect("begins");
        engine.record_draw(cmd, vk::Offset2D::default());
        self.submit(None, None, Some(drawn));
        self.submitted += 1;
    }

    /// A semaphore that is waited for alone orders what is submitted later to its queue, and one that is signalled alone what was
    /// submitted before.
    fn submit(
        &self,
        wait: Option<vk::Semaphore>,
        cmd: Option<vk::CommandBuffer>,
        signal: Option<vk::Semaphore>,
    ) {
        let semaphore = |semaphore| {
            vk::SemaphoreSubmitInfo::default()
                .semaphore(semaphore)
                .stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
        };
        let waits: Vec<_> = wait.into_iter().map(semaphore).collect();
        let signals: Vec<_> = signal.into_iter().map(semaphore).collect();
        let cmd = cmd.map(|cmd| vk::CommandBufferSubmitInfo::default().command_buffer(cmd));
        let submit = vk::SubmitInfo2::default()
            .wait_semaphore_infos(&waits)
            .command_buffer_infos(cmd.as_slice())
            .signal_semaphore_infos(&signals);
        // SAFETY: the command buffer has been recorded, and each semaphore is signalled once before it is waited for.
        unsafe {
            let null = vk::Fence::null();
            self.raw.queue_submit2(self.queue, &[submit], null)
        }
        .expect("submits");
    }

    /// Destroys everything, once the host has waited for the last draw.
    fn close(self) {
        // SAFETY: the last signal may be pending, and nothing afterwards.
        unsafe {
            self.raw.device_wait_idle().expect("waits");
            for (pool, _) in &self.slots {
                self.raw.destroy_command_pool(*pool, None);
            }
            for semaphore in self.semaphores {
                self.raw.destroy_semaphore(semaphore, None);
            }
        }
    }
}

/// The pictures of frames, drawn by a host that has a renderer of this description.
fn pictures(
    scene: &Gaussians,
    frames: &[Frame],
    desc: RendererDesc,
    two_queues: bool,
) -> Vec<Vec<[f32; 4]>> {
    let mut engine = Engine::new(open_host(FLOATS, VIEW, true), scene, ShFormat::Float, desc);
    let mut compute = two_queues.then(|| Compute::new(&engine.host));
    let mut pictures = Vec::new();
    for frame in frames {
        pictures.extend(engine.wait());
        engine.configure(frame);
        match &mut compute {
            Some(compute) => compute.frame(&mut engine),
            None => engine.record(vk::Offset2D::default()),
        }
    }
    pictures.extend(engine.wait());
    pictures.push(engine.wait_for_all());
    if let Some(compute) = compute {
        compute.close();
    }
    engine.close();
    pictures
}

/// Buffers are bound, so that the validation layer watches them.
#[test]
fn frames_that_are_prepared_in_another_queue_show_the_same_pictures() {
    let scene = scene();
    let frames = sweep(&scene);
    let desc = in_flight(FLOATS, Bindings::Bound).reuse(true);
    let expected = pictures(&scene, &frames, desc, false);
    let host = open_host(FLOATS, VIEW, false);
    let family = host.lend().queue_family;
    assert_eq!(host.close(), Vec::<String>::new());
    let found = pictures(&scene, &frames, desc.compute_family(Some(family)), true);
    assert_eq!(found.len(), frames.len());
    for (at, (found, expected)) in found.iter().zip(&expected).enumerate() {
        assert!(found == expected, "frame {at} is another picture");
    }
}

/// The device pretends to have a second family, of which the validation layer does not know.
#[test]
fn memory_is_shared_with_the_families_that_are_named() {
    let host = faults::device(Some(Pretence::SecondFamily)).expect("a device");
    let adopt = |families: &[u32]| {
        let lent = faults::lent(&host).shared_families(families.to_vec());
        // SAFETY: the host outlives the device.
        unsafe { Device::adopt(lent) }
    };
    let refused = |error: rara::Error, says: [&str; 2]| {
        let text = error.to_string();
        assert!(says.iter().all(|part| text.contains(part)), "{text}");
    };
    let unknown = adopt(&[1, 2]).unwrap_err();
    refused(unknown, ["no queue family 2", "AdoptDesc::shared_families"]);

    let desc = RendererDesc::new(BYTES);
    let one = adopt(&[0, 0]).expect("the host's own family");
    drop(Renderer::new(&one, desc.compute_family(Some(0))).expect("a renderer"));
    assert_eq!(host.validation_messages(), Vec::<String>::new());
    let elsewhere = Renderer::new(&one, desc.compute_family(Some(1))).unwrap_err();
    refused(
        elsewhere,
        ["compute_family is 1", "AdoptDesc::shared_families"],
    );

    let two = adopt(&[1]).expect("two families");
    let desc = desc.compute_family(Some(1));
    drop(Renderer::new(&two, desc).expect("a renderer"));
    let messages = host.validation_messages();
    let names_both = |text: &String| text.contains("pQueueFamilyIndices[1]");
    assert!(messages.iter().any(names_both), "{messages:?}");
    let map = rara::DepthMap::ordinary(0.1, 10.0).expect("a map");
    let depth = rara::DepthDesc::new(vk::Format::D32_SFLOAT, map).readable(true);
    for (desc, field) in [
        (desc.depth(Some(depth)), "DepthDesc::readable"),
        (
            desc.timing(true).statistics(true),
            "RendererDesc::statistics",
        ),
    ] {
        let error = Renderer::new(&two, desc).unwrap_err();
        refused(error, ["lacks graphics", field]);
    }
}

/// Without the barriers that a host leaves to its semaphores, the layer sees what the semaphores are for.
#[test]
fn a_host_that_forgets_the_semaphores_is_told_so() {
    let scene = scene();
    let frame = frames(&scene).swap_remove(1);
    let host = open_host(FLOATS, VIEW, true);
    let family = host.lend().queue_family;
    let desc = in_flight(FLOATS, Bindings::Bound).compute_family(Some(family));
    let mut engine = Engine::new(host, &scene, ShFormat::Float, desc);
    engine.configure(&frame);
    engine.record(vk::Offset2D::default());
    engine.wait_for_all();
    drop((engine.configured.take(), engine.prepared.take()));
    drop((engine.renderer, engine.scene, engine.device));
    let messages = engine.host.close();
    assert!(
        messages.iter().any(|text| text.contains("HAZARD")),
        "{messages:?}"
    );
}
