use super::*;

#[test]
fn each_kind_of_clip_comes_once() {
    let limits = FrameLimits::new((64, 64), 1);
    let sizes = |limits: &FrameLimits| -> Vec<(usize, bool)> {
        let clips = limits.clips(DeviceShape::Cpu).expect("proper surfaces");
        let kind = |clip: &Clip| (clip.all_surfaces().len(), clip.is_general());
        clips.iter().map(kind).collect()
    };
    let few = [(0, false), (1, false), (2, false), (3, false), (6, false)];
    assert_eq!(sizes(&limits), few);
    let none = limits.clone().planes(0);
    assert_eq!(sizes(&none), [(0, false)]);
    let bent = limits.clone().planes(0).surfaces(20);
    let kinds = [(0, false), (1, true), (3, true), (9, true), (20, true)];
    assert_eq!(sizes(&bent), kinds);
    let many = limits.planes(40);
    let kinds = [1, 2, 3, 9, 40].map(|count| (count, false));
    assert_eq!(sizes(&many)[1..], kinds);
}

#[test]
fn limits_that_no_frame_can_have_are_refused() {
    let limits = FrameLimits::new((64, 64), 1);
    assert!(limits.check().is_ok());
    for (wrong, named) in [
        (limits.clone().size((0, 64)), "size is 0x64"),
        (limits.clone().layers(0), "layers is 0"),
        (limits.clone().gaussians(u32::MAX), "beyond the 2^32"),
        (limits.clone().surfaces(1 << 17), "131072"),
        (limits.clone().settings(Vec::new()), "settings is empty"),
    ] {
        let error = wrong.check().expect_err("no frame can").to_string();
        assert!(error.contains(named), "{error}");
    }
}
