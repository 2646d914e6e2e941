//! Draws, of vertices and of meshes.

use super::*;

/// Draws the left half of an 8 x 8 image, with arguments, corners and colour written in the same command buffer.
fn draw_half(device: &Device, front: &Shader, bindings: Bindings) {
    let format = vk::Format::R32G32B32A32_SFLOAT;
    let desc = GraphicsDesc {
        name: "square",
        front,
        fragment: &FRAGMENT,
        constants: &[],
        attachments: Attachments::color(format),
        depth: DepthUse::Ignored,
        blend: None,
        topology: vk::PrimitiveTopology::TRIANGLE_STRIP,
        bindings,
    };
    let pipeline = GraphicsPipeline::new(device, &desc).unwrap();
    let image = device
        .create_image(&ImageDesc {
            name: "picture",
            width: 8,
            height: 8,
            format,
        })
        .unwrap();
    let corners = buffer(device, "corners", 32, Location::GpuOnly);
    let paint = buffer(device, "paint", 16, Location::GpuOnly);
    let args = buffer(device, "args", 32, Location::GpuOnly);
    let target = buffer(device, "target", 8 * 8 * 16, Location::Readback);
    let mut timer = Timer::new(device, 2).unwrap();
    let colour = [0.25_f32, 0.5, 0.75, 1.0];
    let frame = |cmd| {
        // SAFETY: `cmd` is recording on `device`, and everything used outlives the wait.
        let mut recorder = unsafe { Recorder::begin(device, cmd, Draws::Around, Some(&mut timer)) };
        recorder.pass("prepare", |recorder| {
            recorder.update(
                &corners,
                0,
                bytemuck::cast_slice(&[-1.0_f32, -1.0, 0.0, -1.0, -1.0, 1.0, 0.0, 1.0]),
            );
            recorder.update(&paint, 0, bytemuck::cast_slice(&colour));
            let arguments: &[u32] = match pipeline.is_mesh() {
                true => &[1, 1, 1],
                false => &[4, 1, 0, 0],
            };
            recorder.update(&args, 4, bytemuck::cast_slice(arguments));
        });
        recorder.ready_to_draw(&[&corners, &paint, &args]);
        // SAFETY: as above; the drawer lives inside the rendering and the buffers were made ready to draw.
        unsafe {
            image.begin_rendering(cmd, [0.0; 4]);
            let mut drawer = Drawer::new(device, cmd, Some(&mut timer));
            drawer.viewport(image.extent().into());
            drawer.pass("draw", |drawer| {
                let buffers = [&corners, &paint];
                if pipeline.is_mesh() {
                    drawer.draw_mesh_tasks_indirect(&pipeline, &buffers, &[], &args, 4);
                } else {
                    drawer.draw_indirect(&pipeline, &buffers, &[], &args, 4);
                }
            });
            image.end_rendering(cmd);
            image.copy_to(cmd, &target);
        }
        Ok(())
    };
    device.submit_and_wait(frame).unwrap();
    for (i, pixel) in target.mapped().chunks_exact(16).enumerate() {
        let expected = if i % 8 < 4 { colour } else { [0.0; 4] };
        assert_eq!(
            pixel,
            bytemuck::bytes_of(&expected),
            "pixel {i}, {bindings:?}"
        );
    }
    if let Some(times) = timer.read() {
        assert_eq!(
            times.iter().map(|(name, _)| *name).collect::<Vec<_>>(),
            ["prepare", "draw"]
        );
    }
}

#[test]
fn draws_read_what_the_same_command_buffer_wrote() {
    clean(|device| {
        for &bindings in all_bindings(device) {
            draw_half(device, &VERTEX, bindings);
        }
    });
}

#[test]
fn mesh_shaders_draw_or_are_refused_with_a_reason() {
    clean(|device| {
        if device.support().mesh_shader {
            for &bindings in all_bindings(device) {
                draw_half(device, &MESH, bindings);
            }
        } else {
            let desc = GraphicsDesc {
                name: "square",
                front: &MESH,
                fragment: &FRAGMENT,
                constants: &[],
                attachments: Attachments::color(vk::Format::R8G8B8A8_UNORM),
                depth: DepthUse::Ignored,
                blend: None,
                topology: vk::PrimitiveTopology::TRIANGLE_LIST,
                bindings: Bindings::Address,
            };
            let error = GraphicsPipeline::new(device, &desc).unwrap_err();
            assert!(error.to_string().contains("VK_EXT_mesh_shader"), "{error}");
        }
    });
}
