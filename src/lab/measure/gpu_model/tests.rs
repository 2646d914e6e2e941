use super::*;

#[test]
fn every_frame_is_predicted_and_more_gaussians_take_longer() {
    let frames = frames();
    assert!(frames.len() >= 4);
    for gpu in &GPUS {
        let total = |frame: &ModelFrame| predict(gpu, frame).iter().map(|p| p.ms).sum::<f64>();
        for kind in [false, true] {
            let mut of_kind = frames.iter().filter(|frame| frame.is_cut == kind);
            let (small, large) = (of_kind.next().unwrap(), of_kind.next().unwrap());
            assert!(small.numbers.blocks < large.numbers.blocks);
            assert!(
                total(small) > 0.0 && total(large) > total(small),
                "{}",
                gpu.name
            );
        }
    }
}

#[test]
fn a_pass_takes_its_longest_time_and_its_gaps() {
    for frame in frames() {
        for p in predict(&GPUS[0], &frame) {
            let least = p.memory.max(p.instructions).max(p.chain);
            let gaps = f64::from(p.dispatches) * GAP / 1e3;
            assert!((p.ms - least - gaps).abs() < 1e-9, "{p:?}");
            // In these frames no depth has a tie, so that its pass looks whether there are any and ends.
            let works = p.memory > 0.0 && p.instructions > 0.0;
            let is_idle = p.pass == "radix_large_ties" && p.bytes == 0;
            assert!(p.chain > 0.0 && (works || is_idle), "{p:?}");
        }
    }
}

#[test]
fn memory_twice_as_fast_helps_what_waits_for_memory_alone() {
    let gpu = &GPUS[0];
    let fast = Gpu {
        bandwidth: 2.0 * gpu.bandwidth,
        ..*gpu
    };
    for frame in frames() {
        for (slow, fast) in predict(gpu, &frame).iter().zip(predict(&fast, &frame)) {
            assert!((slow.memory - 2.0 * fast.memory).abs() < 1e-9);
            assert_eq!(
                (slow.instructions, slow.chain),
                (fast.instructions, fast.chain)
            );
            assert!(fast.ms <= slow.ms);
        }
    }
}

#[test]
fn the_guide_and_the_front_page_say_what_is_predicted() {
    let guide = include_str!("../../../guide/gpu.md");
    let front = include_str!("../../../../README.md");
    // Two digits.
    let told = |ms: f64| format!("{ms:.*}", if ms < 1.0 { 2 } else { 1 });
    for frame in frames() {
        let sum = |gpu: &Gpu| predict(gpu, &frame).iter().map(|p| p.ms).sum::<f64>();
        let sums = GPUS.each_ref().map(sum).map(told);
        let cut = if frame.is_cut {
            ", cut in half, mode `exact`"
        } else {
            ""
        };
        let millions = frame.gaussians / 1_000_000;
        let row = format!("| {millions} M{cut} | {} |", sums.join(" | "));
        assert!(guide.contains(&row), "src/guide/gpu.md should say {row}");
        let said = front.contains(&format!("{} ms for {millions} M", sums[0]));
        assert!(frame.is_cut || said, "README.md should say {} ms", sums[0]);
    }
    for gpu in &GPUS {
        let Gpu {
            name,
            bandwidth,
            lanes,
            clock,
            latency,
        } = gpu;
        let row = format!("| {name} | {bandwidth} | {lanes} | {clock} | {latency} |");
        assert!(guide.contains(&row), "src/guide/gpu.md should say {row}");
    }
}

#[test]
fn devices_are_known_by_their_names() {
    assert_eq!(named("NVIDIA GeForce RTX 4090").unwrap().name, "RTX 4090");
    assert_eq!(
        named("AMD Radeon RX 7900 XTX (RADV NAVI31)").unwrap().name,
        "RX 7900 XTX"
    );
    assert_eq!(named("llvmpipe (LLVM 19.1.7, 256 bits)"), None);
}
