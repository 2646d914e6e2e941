//! How near each way of cutting comes to the truth, on trained and generated scenes.

use crate::common;
use glam::DVec3;
use rara::scene::Bounds;
use rara::{Camera, Clip, ClipOp, Decay, ExactForm, Gaussians, Miss, Mode, Plane, Settings};
use rara_lab::measure::{Comparison, compare};

/// Mean absolute difference of the channels, of 255.
const L1_ANYWHERE: f64 = 0.1;
const L1_HAIR_AND_ANATOMY: f64 = 0.03;
const SSIM: f64 = 0.999;
/// How many times nearer to the truth `exact` is than any other way.
const NEARER: f64 = 10.0;

/// The scene as it is framed, cut through its middle by a plane along the view.
fn view(scene: &Gaussians) -> (Camera, Clip) {
    let bounds = Bounds::of(scene);
    let size = common::scaled((256, 256));
    let camera = Camera::frame(&bounds, -DVec3::Y, 50.0, size).expect("a view");
    let clip = Clip::of(
        [Plane::new(DVec3::X, -bounds.centre().x).expect("a plane")],
        ClipOp::And,
    );
    (camera, clip)
}

#[test]
fn exact_is_ten_times_nearer_to_the_truth_than_any_other_way() {
    let mut headless = common::headless();
    let mut scenes = common::trained_scenes();
    scenes.extend(common::generated_scenes(20_000));
    for (name, scene) in scenes {
        let (camera, clip) = view(&scene);
        // The truth cuts every splat along true rays, so that what bands and fits leave out counts as error.
        let truth = Settings::default()
            .form(ExactForm::Beam)
            .decay(Some(Decay::Depth))
            .trace_all(true);
        let truth = rara_reference::render::<f64>(&scene, &camera, &clip, &truth).picture;
        headless.load(&scene).expect("uploads");
        let mut error = |settings: Settings| -> Comparison {
            headless.render(&camera, &clip, &settings).expect("renders");
            compare(&headless.picture().expect("reads back"), &truth).expect("the same size")
        };
        let mode = |mode| Settings::default().mode(mode);
        let exact = error(mode(Mode::Exact));
        let is_fine = name == "hair_bear" || name == "mni_layers";
        let most = if is_fine {
            L1_HAIR_AND_ANATOMY
        } else {
            L1_ANYWHERE
        };
        assert!(exact.l1 <= most && exact.ssim >= SSIM, "{name}: {exact:?}");
        let paper = |sigma, miss| mode(Mode::Rara).sigma(sigma).miss(miss);
        for (way, settings) in [
            ("by centres", mode(Mode::Hard)),
            ("the paper's text", paper(1.0, Miss::Keep)),
            ("its released code", paper(3.0, Miss::Drop)),
            ("its length ratio by the peak", mode(Mode::Rara)),
        ] {
            let other = error(settings);
            assert!(
                other.l1 >= NEARER * exact.l1,
                "{name}, {way}: {other:?} against {exact:?}"
            );
        }
    }
}
