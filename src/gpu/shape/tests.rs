use super::*;

#[test]
fn shapes_are_chosen_by_kind_unless_asked_for() {
    let with = |full_subgroups| Support {
        full_subgroups,
        max_shared_memory: SHARED_MEMORY,
        ..Support::default()
    };
    let of = |subgroup| DeviceShape::Gpu { subgroup };
    for (sizes, chosen) in [
        ([0, 0], 0),
        ([8, 8], 8),
        ([32, 64], 32),
        ([64, 64], 64),
        ([8, 16], 16),
    ] {
        assert_eq!(DeviceShape::gpu(&with(sizes)), of(chosen));
        assert!(DeviceShape::gpu(&with(sizes)).check(&with(sizes)).is_ok());
    }
    let support = with([8, 32]);
    let named = |text| DeviceShape::named(text, &support).ok();
    assert_eq!(named("cpu"), Some(DeviceShape::Cpu));
    assert_eq!(named("gpu"), Some(of(32)));
    assert_eq!(named("gpu:0"), Some(of(0)));
    for text in ["", "GPU", "gpu:", "gpu:-1", "cpu:8", "tpu"] {
        assert_eq!(named(text), None);
    }
    for (subgroup, possible) in [
        (0, true),
        (4, false),
        (8, true),
        (12, false),
        (32, true),
        (64, false),
    ] {
        assert_eq!(of(subgroup).check(&support).is_ok(), possible);
    }
}
