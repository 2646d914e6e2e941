use super::*;

#[test]
fn names_and_choices_are_distinct() {
    let all = variants(Settings::default());
    for (i, a) in all.iter().enumerate() {
        for b in &all[..i] {
            assert_ne!(a.name, b.name);
            let twice = a.settings == b.settings;
            assert!(!twice, "{} is {}", a.name, b.name);
        }
    }
}

#[test]
fn every_choice_of_precision_is_compared_by_itself() {
    let usual = Settings::default().precision;
    let mut counts = [0; 6];
    for variant in variants(Settings::default()) {
        let own = variant.settings.precision;
        let (target, sh, phi, key_bits, beam_switch, transmittance_min) = own.fields();
        let singles = [
            usual.target(target),
            usual.sh(sh),
            usual.phi(phi),
            usual.key_bits(key_bits),
            usual.beam_switch(beam_switch),
            usual.transmittance_min(transmittance_min),
        ];
        for (count, single) in counts.iter_mut().zip(singles) {
            *count += usize::from(own != usual && own == single);
        }
    }
    assert!(!counts.contains(&0), "{counts:?}");
}
