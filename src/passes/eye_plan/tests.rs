//! Tests of what a clip changes in a plan.

use glam::DVec3;

use super::*;
use crate::passes::pipelines::{Pipeline, PipelineKey};
use crate::passes::shaders::project;
use crate::passes::splat_colours::SplatColours;
use crate::passes::weight::Weight;
use rara_scene::clip::{Clip, ClipOp, Plane};
use rara_scene::settings::Mode;
use rara_scene::{Kind, Layer, Numbers, generate};

fn plan(mode: Mode, planes: usize) -> EyePlan {
    let thousand = generate(Kind::General, 1000, 1);
    let layer = SceneLayer::new(&Layer::new("one", &thousand), 0, Numbers::of_whole(0));
    let scene = SceneFacts {
        layers: &[layer],
        gaussians: 1000,
        blocks: 4,
        reordered: false,
        sh_degree: 0,
        sh_format: ShFormat::Float,
        shape: DeviceShape::Cpu,
    };
    let facts = EyeFacts {
        sort_runs: 128,
        span_runs: 128,
        raster: Raster::Tiles,
        tile_work: TileWork::suiting(DeviceShape::Cpu, 8),
        picture: None,
        pair_capacity: 1000,
        occluders: None,
        expects_depth: false,
        write_alpha: None,
        draws_motion: false,
        whole: None,
        colours: SplatColours::Scene,
    };
    let eye = DVec3::new(0.0, 0.0, -4.0);
    let camera = Camera::look_at(eye, DVec3::ZERO, -DVec3::Y, 50.0, (64, 64));
    let plane = Plane::new(DVec3::X, 0.0).expect("a finite normal");
    let clip = Clip::of(vec![plane; planes], ClipOp::And);
    let settings = Settings::default().mode(mode);
    let camera = camera.expect("a view");
    let cut = CutPlan::new(scene, Some(&camera), &clip, &settings).expect("a cut");
    EyePlan::new(scene, cut, facts, &camera, &settings).expect("a plan")
}

/// The pipeline that projects.
fn projects_by(plan: &EyePlan) -> PipelineKey {
    Pipeline::<project::Program>::from_plan(plan).key()
}

#[test]
fn without_planes_every_mode_is_none_to_the_pipeline_and_the_byte() {
    let none = plan(Mode::None, 0);
    assert_eq!(none.skipped(), ["clip", "cutoff"]);
    for (mode, planes) in [
        (Mode::None, 2),
        (Mode::Hard, 0),
        (Mode::Rara, 0),
        (Mode::Exact, 0),
    ] {
        let plan = plan(mode, planes);
        assert_eq!(plan.work, none.work);
        assert_eq!(
            plan.cut.mode(),
            none.cut.mode(),
            "the blocks' and the classes' pipeline"
        );
        assert_eq!(Weight::from_plan(&plan), Weight::from_plan(&none));
        assert_eq!(projects_by(&plan), projects_by(&none));
        assert_eq!(
            (plan.cut.cuts(), plan.data.weight.cut_stride),
            (false, 0),
            "no record"
        );
        let bytes = |plan: &EyePlan| {
            [
                bytemuck::bytes_of(&plan.cut.data),
                bytemuck::bytes_of(&plan.data),
            ]
            .concat()
        };
        assert!(bytes(&plan) == bytes(&none), "{mode:?}");
    }
}

#[test]
fn a_hard_clip_needs_no_records_and_no_weights() {
    let (none, hard) = (plan(Mode::None, 0), plan(Mode::Hard, 1));
    assert_eq!(hard.skipped(), ["cutoff"]);
    assert_eq!(Weight::from_plan(&hard), Weight::from_plan(&none));
    assert_eq!(projects_by(&hard), projects_by(&none));
}
