//! The paper's second table. The plane stands so far away that it cuts nothing, so every mode should draw the picture that
//! mode `none` draws; only tracing Gaussians that are not cut can make a difference.

use glam::DVec3;
use rara::scene::Bounds;
use rara::{Camera, Clip, ClipOp, Headless, Miss, Mode, Plane, Result, Scene, Settings};
use serde::{Deserialize, Serialize};

use crate::frames::picture;
use crate::measure;
use crate::table::{Cell, Table};

#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct AblationRow {
    pub what: String,
    /// Splats that are weighed.
    pub cutoff: u32,
    /// Mean absolute difference, on a scale of 0 to 255.
    pub l1: f64,
    /// Root of the mean squared difference, on that scale.
    pub rmse: f64,
    /// Peak signal to noise ratio, decibels; `None` where the pictures are equal.
    pub psnr: Option<f64>,
    /// Structural similarity, 1 where the pictures are equal.
    pub ssim: f64,
    /// Largest difference of a channel, on a scale of 0 to 255.
    pub max: f64,
    /// Share of the pixels of which a channel differs by more than 2/255.
    pub share_over_2: f64,
}

/// Draws a scene with a plane at infinity in every mode and reading. The device holds the scene.
pub fn ablation(
    headless: &mut Headless,
    scene: &Scene<'_>,
    camera: &Camera,
    look: &Settings,
) -> Result<Vec<AblationRow>> {
    let bounds = Bounds::of(scene);
    let reach = bounds
        .min
        .abs()
        .max(bounds.max.abs())
        .max_element()
        .max(1.0);
    let far = Clip::of([Plane::new(DVec3::Z, 1e9 * reach)?], ClipOp::And);
    let (truth, _) = picture(headless, camera, &Clip::default(), &look.mode(Mode::None))?;
    let row = |(what, settings): (&str, Settings)| {
        let (drawn, stats) = picture(headless, camera, &far, &settings)?;
        let c = measure::compare(&drawn, &truth)?;
        Ok(AblationRow {
            what: what.into(),
            cutoff: stats.counts.cutoff,
            l1: c.l1,
            rmse: c.rmse,
            psnr: Some(c.psnr).filter(|psnr| psnr.is_finite()),
            ssim: c.ssim,
            max: c.max,
            share_over_2: c.share_over_2,
        })
    };
    readings(*look).into_iter().map(row).collect()
}

pub fn table(title: &str, rows: &[AblationRow]) -> Table {
    let note = "Every picture has a plane at infinity and is compared with that of mode none. L1 is on a scale of 0 to 255.";
    let mut table = Table::new(
        title,
        note,
        ["against mode none", "weighed", "L1", "SSIM", "largest"],
    );
    for row in rows {
        table.row([
            row.what.as_str().into(),
            row.cutoff.into(),
            Cell::Fixed(row.l1, 4),
            Cell::Fixed(row.ssim, 6),
            row.max.into(),
        ]);
    }
    table
}

/// What is compared: the modes, and what the paper's text and its released code may mean by tracing everything.
fn readings(look: Settings) -> Vec<(&'static str, Settings)> {
    let mode = |mode| look.mode(mode);
    let all = |miss, sigma| mode(Mode::Rara).trace_all(true).miss(miss).sigma(sigma);
    vec![
        ("hard", mode(Mode::Hard)),
        ("rara", mode(Mode::Rara)),
        ("exact", mode(Mode::Exact)),
        ("exact, all traced", mode(Mode::Exact).trace_all(true)),
        ("rara, all traced, keep 1s", all(Miss::Keep, 1.0)),
        ("rara, all traced, keep 3s", all(Miss::Keep, 3.0)),
        ("rara, all traced, drop 1s", all(Miss::Drop, 1.0)),
        ("rara, all traced, drop 3s", all(Miss::Drop, 3.0)),
        ("rara, all traced, peak 3s", all(Miss::Peak, 3.0)),
    ]
}
