//! `rara info`: what is in a scene.

use clap::Args;
use glam::DVec3;
use rara::Gaussians;
use serde::Serialize;

use super::failure::Failure;
use super::output::{self, grouped};
use super::scenes::SceneArgs;
use super::up;
use rara::scene::Bounds;
use rara::scene::layers::LoadedLayer;
use rara_reference::classify::{Bands, bands};

/// Show what is in a scene
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  rara info scene.ply

The command first prints what the loader repaired or dropped. Statistics are the smallest value, the 1st, 50th and 99th
percentiles, and the largest value. Robust bounds ignore, along each axis, the lowest and the highest percent of
the centres, and are wider by the largest deviation of the median Gaussian; shares in --clip and --section are shares of these bounds.
Elongation is the longest axis of a Gaussian divided by the middle one, and flatness the middle one divided by the shortest.")]
pub(super) struct Info {
    /// Print the same facts as JSON to standard output
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    scenes: SceneArgs,
}

#[derive(Debug, Serialize)]
struct InfoJson {
    gaussians: usize,
    layers: Vec<LayerFacts>,
    sh_degree: u32,
    repaired: u64,
    dropped: u64,
    notes: Vec<String>,
    #[serde(flatten)]
    facts: Facts,
}

#[derive(Debug, Serialize)]
struct Facts {
    /// Box around all centres.
    centres: Extent,
    /// Box without the stray centres, along which sections and sweeps count.
    robust_bounds: Extent,
    opacity: Spread,
    /// The deviations along each Gaussian's longest axis, world units.
    scale: Spread,
    /// Longest to middle axis, so that flat Gaussians do not count as needles.
    elongation: Spread,
    /// Middle to shortest axis.
    flatness: Spread,
    /// Shares of the Gaussians that a plane through the middle cuts, the mean over 13 normals.
    cut: Bands,
}

#[derive(Debug, Clone, Copy, Serialize)]
struct Extent {
    min: [f64; 3],
    max: [f64; 3],
}

/// A value's distribution; infinite ratios are null in the JSON.
#[derive(Debug, Clone, Copy, Serialize)]
struct Spread {
    min: f32,
    p1: f32,
    median: f32,
    p99: f32,
    max: f32,
}

#[derive(Debug, Serialize)]
struct LayerFacts {
    name: String,
    format: String,
    gaussians: usize,
    opacity: f32,
    visible: bool,
    /// Whether it was trained antialiased and is drawn so.
    antialiased: bool,
    /// The low-pass that it was trained with, px^2.
    low_pass: f32,
    /// The order that it asks for: depth or distance.
    sort_by: String,
    /// The most that one of its splats covers of a pixel.
    alpha_max: f32,
    /// Whether its colours are linear light.
    linear: bool,
    /// What its centres are counted from, its own units; zero unless it is far from there.
    origin: [f64; 3],
    /// The direction that is up, where its file says so.
    up: Option<[f64; 3]>,
    clipped: bool,
    /// What else there is to say of it, where it is one of several.
    #[serde(rename = "statistics", skip_serializing_if = "Option::is_none")]
    facts: Option<Facts>,
}

impl LayerFacts {
    fn from_layer(layer: &LoadedLayer) -> Self {
        Self {
            name: layer.name.clone(),
            format: layer
                .format
                .map_or_else(|| "none".into(), |format| format.to_string()),
            gaussians: layer.gaussians.len(),
            opacity: layer.state.opacity,
            visible: layer.state.visible,
            antialiased: layer.gaussians.is_antialiased(),
            low_pass: layer.gaussians.low_pass(),
            origin: layer.gaussians.origin().into(),
            sort_by: layer.gaussians.training().sort_by.to_string(),
            alpha_max: layer.gaussians.training().alpha_max,
            linear: layer.gaussians.training().linear,
            up: layer.up.map(Into::into),
            clipped: layer.clip.is_some(),
            facts: None,
        }
    }
}

impl Spread {
    fn from_values(values: impl Iterator<Item = f32>) -> Self {
        let mut values: Vec<f32> = values.collect();
        values.sort_unstable_by(f32::total_cmp);
        let at = |share: f64| {
            let index = (share * values.len().saturating_sub(1) as f64).round() as usize;
            values.get(index).copied().unwrap_or(0.0)
        };
        Self {
            min: at(0.0),
            p1: at(0.01),
            median: at(0.5),
            p99: at(0.99),
            max: at(1.0),
        }
    }
}

impl Extent {
    fn new(min: DVec3, max: DVec3) -> Self {
        Self {
            min: min.to_array(),
            max: max.to_array(),
        }
    }
}

impl Facts {
    fn from_gaussians(gaussians: &Gaussians) -> Self {
        let sorted = |index: usize| {
            let mut axes = gaussians.scales()[index].to_array();
            axes.sort_unstable_by(f32::total_cmp);
            axes
        };
        let all = 0..gaussians.len();
        let ratio = |long: f32, short: f32| if long == short { 1.0 } else { long / short };
        let centres = all.clone().map(|index| gaussians.centre(index));
        let empty = if gaussians.is_empty() {
            DVec3::ZERO
        } else {
            DVec3::INFINITY
        };
        let robust = Bounds::of(gaussians);
        Self {
            centres: Extent::new(
                centres.clone().fold(empty, DVec3::min),
                centres.fold(-empty, DVec3::max),
            ),
            robust_bounds: Extent::new(robust.min, robust.max),
            opacity: Spread::from_values(gaussians.opacities().iter().copied()),
            scale: Spread::from_values(all.clone().map(|i| sorted(i)[2])),
            elongation: Spread::from_values(all.clone().map(|i| ratio(sorted(i)[2], sorted(i)[1]))),
            flatness: Spread::from_values(all.map(|i| ratio(sorted(i)[1], sorted(i)[0]))),
            cut: bands(gaussians),
        }
    }

    fn lines(&self) -> Vec<String> {
        let corner = |[x, y, z]: [f64; 3]| format!("{x:.4}, {y:.4}, {z:.4}");
        let extent = |e: Extent| format!("({}) to ({})", corner(e.min), corner(e.max));
        let spread = |s: Spread| {
            format!(
                "{:>11.4e} {:>11.4e} {:>11.4e} {:>11.4e} {:>11.4e}",
                s.min, s.p1, s.median, s.p99, s.max
            )
        };
        let Bands { ours, paper } = self.cut;
        vec![
            format!("centres        {}", extent(self.centres)),
            format!("robust bounds  {}", extent(self.robust_bounds)),
            format!(
                "{:>26} {:>11} {:>11} {:>11} {:>11}",
                "min", "1 %", "median", "99 %", "max"
            ),
            format!("opacity        {}", spread(self.opacity)),
            format!("scale          {}", spread(self.scale)),
            format!("elongation     {}", spread(self.elongation)),
            format!("flatness       {}", spread(self.flatness)),
            format!(
                "cut by a plane through the middle (mean of 13 directions): {:.2} % of the Gaussians; by the test of the RaRa paper: {:.2} %",
                100.0 * ours,
                100.0 * paper
            ),
        ]
    }
}

impl Info {
    pub(super) fn run(self) -> Result<(), Failure> {
        let mut loaded = self.scenes.load()?;
        let (repaired, dropped) = (loaded.repaired, loaded.dropped);
        let notes = std::mem::take(&mut loaded.notes);
        let mut layers: Vec<_> = loaded.layers.iter().map(LayerFacts::from_layer).collect();
        if layers.len() > 1 {
            for (facts, layer) in layers.iter_mut().zip(&loaded.layers) {
                let mut placed = layer.gaussians.clone();
                // What single precision cannot hold there is in no picture either.
                let _ = placed.place(&layer.state.placement);
                facts.facts = Some(Facts::from_gaussians(&placed));
            }
        }
        let gaussians = &loaded.merged();
        let document = InfoJson {
            gaussians: gaussians.len(),
            layers,
            sh_degree: gaussians.sh_degree(),
            repaired,
            dropped,
            notes,
            facts: Facts::from_gaussians(gaussians),
        };
        if self.json {
            return Ok(output::json(&document)?);
        }
        Ok(output::answer(&table(&document).join("\n"))?)
    }
}

fn table(document: &InfoJson) -> Vec<String> {
    let mut lines = Vec::new();
    lines.push(format!(
        "gaussians      {}",
        grouped(document.gaussians as u64)
    ));
    for layer in document.layers.iter().filter(|_| document.layers.len() > 1) {
        let state = match (layer.visible, layer.clipped) {
            (false, _) => ", hidden",
            (true, true) => ", with a clip of its own",
            (true, false) => "",
        };
        let trained = if layer.antialiased {
            ", antialiased"
        } else {
            ""
        };
        let low_pass = layer.low_pass;
        lines.push(format!(
            "  layer        {} ({}): {}, opacity {}{trained}, low-pass {low_pass}, by {}{state}",
            layer.name,
            layer.format,
            grouped(layer.gaussians as u64),
            layer.opacity,
            layer.sort_by,
        ));
    }
    if let [layer] = &document.layers[..] {
        lines.push(format!("format         {}", layer.format));
        let trained = if layer.antialiased { "yes" } else { "no" };
        lines.push(format!("antialiased    {trained}"));
        lines.push(format!("low-pass       {} px^2", layer.low_pass));
        lines.push(format!("sorted by      {}", layer.sort_by));
        let colours = if layer.linear { "linear light" } else { "sRGB" };
        lines.push(format!(
            "colours        {colours}, alpha up to {}",
            layer.alpha_max
        ));
        if let Some(up) = layer.up {
            lines.push(format!("up             {}", up::direction_text(up.into())));
        }
        if layer.origin != [0.0; 3] {
            let [x, y, z] = layer.origin;
            lines.push(format!("origin         ({x}, {y}, {z})"));
        }
    }
    lines.push(format!("SH degree      {}", document.sh_degree));
    lines.push(format!("repaired       {}", grouped(document.repaired)));
    lines.push(format!("dropped        {}", grouped(document.dropped)));
    lines.extend(document.facts.lines());
    for layer in &document.layers {
        if let Some(facts) = &layer.facts {
            lines.push(format!("\nlayer {}", layer.name));
            lines.extend(facts.lines().into_iter().map(|line| format!("  {line}")));
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::Spread;

    #[test]
    fn spreads_pick_by_rank_and_take_no_values_at_all() {
        let spread = Spread::from_values((0..=100).rev().map(|v| v as f32));
        assert_eq!(
            [spread.min, spread.p1, spread.median, spread.p99, spread.max],
            [0.0, 1.0, 50.0, 99.0, 100.0]
        );
        assert_eq!(Spread::from_values(std::iter::empty()).max, 0.0);
    }
}
