use super::same_size;
use rara::{Picture, Result};
use rara_reference::maps;

/// How much a sequence of pictures changes from step to step, in units of 1/255, each the mean over the steps. A pixel's
/// change is that of the channel that changes most.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
pub struct Popping {
    pub worst: f64,
    pub mean: f64,
    /// The largest change of a pixel beyond what the same pixel changes by in the truth.
    pub worst_beyond: f64,
    /// The mean of the changes beyond the truth's.
    pub mean_beyond: f64,
}

/// Measures a sequence of pictures against that of the truth. Both have the same number of pictures of one size.
pub fn popping(pictures: &[Picture], truth: &[Picture]) -> Result<Popping> {
    assert_eq!(pictures.len(), truth.len(), "a truth for every picture");
    let mut total = Popping::default();
    let steps = pictures.len().saturating_sub(1);
    for (ours, theirs) in pictures.windows(2).zip(truth.windows(2)) {
        for picture in [&ours[1], &theirs[0], &theirs[1]] {
            same_size(&ours[0], picture)?;
        }
        let (mut worst, mut sum, mut worst_beyond, mut sum_beyond) = (0.0_f64, 0.0, 0.0_f64, 0.0);
        let pixels = ours[0].pixels.len();
        for i in 0..pixels {
            let change = maps::change(&ours[0].pixels[i], &ours[1].pixels[i]);
            let beyond =
                (change - maps::change(&theirs[0].pixels[i], &theirs[1].pixels[i])).max(0.0);
            worst = worst.max(change);
            sum += change;
            worst_beyond = worst_beyond.max(beyond);
            sum_beyond += beyond;
        }
        let share = 1.0 / steps as f64;
        total.worst += share * worst;
        total.mean += share * sum / pixels as f64;
        total.worst_beyond += share * worst_beyond;
        total.mean_beyond += share * sum_beyond / pixels as f64;
    }
    Ok(total)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_the_truth_does_not_do_is_beyond_it() {
        let grey = |v: f32| Picture::filled(2, 2, [v / 255.0, 0.0, 0.0, 1.0]);
        let truth = [grey(0.0), grey(10.0), grey(10.0)];
        let same = popping(&truth, &truth).unwrap();
        assert!((same.worst - 5.0).abs() < 1e-4 && (same.mean - 5.0).abs() < 1e-4);
        assert_eq!((same.worst_beyond, same.mean_beyond), (0.0, 0.0));
        // One pixel of four jumps a step late, by 20.
        let mut late = truth.clone();
        late[1].pixels[3][0] = 0.0;
        late[2].pixels[3][0] = 20.0 / 255.0;
        let late = popping(&late, &truth).unwrap();
        assert!((late.worst - (10.0 + 20.0) / 2.0).abs() < 1e-4);
        assert!((late.worst_beyond - 20.0 / 2.0).abs() < 1e-4);
        assert!((late.mean_beyond - 20.0 / 4.0 / 2.0).abs() < 1e-4);
        assert!((late.mean - (7.5 + 5.0) / 2.0).abs() < 1e-4);
    }

    #[test]
    fn a_single_picture_does_not_pop() {
        let one = [Picture::filled(3, 3, [0.5; 4])];
        assert_eq!(popping(&one, &one).unwrap(), Popping::default());
    }
}
