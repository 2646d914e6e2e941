use super::*;

fn chosen(shape: DeviceShape, mesh_shader: bool, targets: Targets) -> Raster {
    let mut support = Support::default();
    support.mesh_shader = mesh_shader;
    let settings = Settings::default();
    let (raster, reason) = raster(&settings, &support, shape, targets).expect("a choice");
    assert!(!reason.is_empty());
    raster
}

#[test]
fn linear_light_without_tiles_is_refused() {
    let targets = Targets {
        tiles: 1000,
        hidden: false,
        multisampled: false,
        beside: false,
        converted: true,
    };
    let hidden = Targets {
        hidden: true,
        ..targets
    };
    let (usual, support) = (Settings::default(), Support::default());
    for (settings, targets) in [(usual.raster(Raster::Quad), targets), (usual, hidden)] {
        let refused = raster(&settings, &support, DeviceShape::Cpu, targets);
        let text = refused.expect_err("quads").to_string();
        assert!(text.contains("ColorSpace::Linear"), "{text}");
    }
}

#[test]
fn tiles_are_chosen_where_they_can_draw() {
    let gpu = DeviceShape::Gpu { subgroup: 32 };
    let usual = Targets {
        tiles: 1000,
        hidden: false,
        multisampled: false,
        beside: false,
        converted: false,
    };
    let hidden = Targets {
        hidden: true,
        ..usual
    };
    let multisampled = Targets {
        multisampled: true,
        ..usual
    };
    let large = Targets {
        tiles: 1 << 21,
        ..usual
    };
    for mesh_shader in [false, true] {
        assert_eq!(chosen(gpu, mesh_shader, usual), Raster::Tiles);
        let draws = if mesh_shader {
            Raster::Mesh
        } else {
            Raster::Quad
        };
        for targets in [hidden, multisampled, large] {
            assert_eq!(chosen(gpu, mesh_shader, targets), draws, "{targets:?}");
        }
        assert_eq!(chosen(DeviceShape::Cpu, mesh_shader, usual), Raster::Tiles);
        let linear = Targets {
            converted: true,
            ..multisampled
        };
        assert_eq!(chosen(gpu, mesh_shader, linear), Raster::Tiles);
        assert_eq!(
            chosen(DeviceShape::Cpu, mesh_shader, multisampled),
            Raster::Tiles
        );
        for targets in [hidden, large] {
            assert_eq!(chosen(DeviceShape::Cpu, mesh_shader, targets), Raster::Quad);
        }
    }
}

#[test]
fn buffers_are_reached_as_the_device_can() {
    use Bindings::{Address, Bound, Mixed};
    let mut support = Support::default();
    support.max_storage_buffer_range = 1000;
    for (addresses, binds, largest, taken) in [
        (true, true, 1000, [Address, Bound, Mixed]),
        (true, true, 1001, [Address, Address, Mixed]),
        (true, false, 1, [Address; 3]),
        (false, true, 1000, [Bound; 3]),
    ] {
        (support.buffer_device_address, support.push_descriptor) = (addresses, binds);
        let taken_by = [Address, Bound, Mixed].map(|wanted| bindings(&support, wanted, largest));
        let taken_by = taken_by.map(|taken| taken.expect("there is a way"));
        assert_eq!(taken_by, taken, "{addresses}, {binds}, {largest}");
    }
    let refused = bindings(&support, Address, 1001).expect_err("neither way has room");
    let text = refused.to_string();
    for says in ["1001 bytes", "at most 1000", "bufferDeviceAddress"] {
        assert!(text.contains(says), "{text}");
    }
}
