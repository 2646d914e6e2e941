//! The report of all experiments: a page that needs no other file, the same as Markdown, and the numbers for programs.

use std::fmt::Write as _;
use std::path::Path;

use askama::Template;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use rara::{Error, Result, Settings};
use rara_base::counted::counted;
use rara_base::files::write_atomically;

use super::results::{Choices, Maps, Results};
use super::{ablation, efficiency, qualities, series};
use crate::bench::ways;
use crate::charts::{Axis, Plot, Series as Points};
use crate::table::{Table, escaped};
use rara_reference::maps;

#[derive(Template)]
#[template(path = "paper.html")]
struct Page {
    title: String,
    about: Vec<String>,
    columns: usize,
    sections: Vec<Section>,
}

struct Section {
    id: &'static str,
    title: &'static str,
    text: Vec<String>,
    body: String,
    tables: Vec<Table>,
}

/// Writes everything into the folder.
pub(super) fn write(folder: &Path, results: &Results) -> Result<()> {
    let sections = vec![
        efficiency_section(results),
        ablation_section(results),
        maps_section(folder, results)?,
        qualities_section(results),
        choices_section(results),
        series_section(results),
    ];
    let page = Page {
        title: "RaRa Clipper's experiments, by rara".into(),
        about: about(results),
        columns: 1 + ways(Settings::default()).len(),
        sections,
    };
    let html = page
        .render()
        .map_err(|error| Error::Invalid(error.to_string()))?;
    let save = |name: &str, text: &str| {
        let path = folder.join(name);
        write_atomically(&path, |file| file.write_all(text.as_bytes()))
    };
    save("index.html", &html)?;
    save("report.md", &markdown(&page))?;
    for section in &page.sections {
        for (index, table) in section.tables.iter().enumerate() {
            save(&format!("{}-{}.csv", section.id, index + 1), &table.csv())?;
        }
    }
    let json = serde_json::to_string_pretty(results).expect("results have string keys only");
    save("results.json", &(json + "\n"))
}

fn about(results: &Results) -> Vec<String> {
    let scenes = results.scenes.iter();
    let scenes: Vec<_> = scenes
        .map(|(name, count)| format!("{name} ({count})"))
        .collect();
    vec![
        format!(
            "Measured by rara {} on {} ({}) in {:.0} minutes. Every error is against pictures of the exact cut, computed in \
             double precision by the reference, which shares no code with the shaders.",
            results.version,
            results.device,
            results.driver,
            results.seconds / 60.0
        ),
        format!("Scenes, with their Gaussians: {}.", scenes.join(", ")),
        format!(
            "Timed pictures have {0}x{0} pixels, those of the cases {1}x{1}; a plane moves in {2} frames, and a slow sweep has {3} \
             steps.",
            results.options.size,
            results.options.case_size,
            results.options.frames,
            results.options.steps
        ),
    ]
}

fn markdown(page: &Page) -> String {
    let mut text = format!("# {}\n\n{}\n", page.title, page.about.join("\n\n"));
    for section in &page.sections {
        let _ = writeln!(text, "\n# {}\n", section.title);
        if !section.text.is_empty() {
            let _ = writeln!(text, "{}\n", section.text.join("\n\n"));
        }
        let tables: Vec<_> = section.tables.iter().map(Table::markdown).collect();
        text += &tables.join("\n");
    }
    text
}

fn html(tables: &[Table]) -> String {
    let one = |table: &Table| {
        let (title, note) = (escaped(&table.title), escaped(&table.note));
        format!("<h3>{title}</h3>\n<p>{note}</p>\n{}", table.html())
    };
    tables.iter().map(one).collect()
}

fn charts(svgs: impl IntoIterator<Item = String>) -> String {
    let all: String = svgs
        .into_iter()
        .map(|svg| format!("<div>{svg}</div>\n"))
        .collect();
    format!("<div class=\"charts\">\n{all}</div>\n")
}

fn efficiency_section(results: &Results) -> Section {
    let all = &results.efficiency;
    let tables = vec![efficiency::table(all), efficiency::stages(all)];
    Section {
        id: "efficiency",
        title: "Render efficiency",
        text: Vec::new(),
        body: html(&tables),
        tables,
    }
}

/// What the paper has for tracing everything: the general scene and the hair, L1 and SSIM each.
const WITHOUT: [(&str, f64, f64); 2] = [("360bonsai", 8.5359, 0.5759), ("Hair", 0.3210, 0.9968)];

fn ablation_section(results: &Results) -> Section {
    let table = |(scene, rows): &(String, Vec<ablation::AblationRow>)| ablation::table(scene, rows);
    let tables: Vec<Table> = results.ablation.iter().map(table).collect();
    let paper = WITHOUT.map(|(scene, l1, ssim)| format!("L1 {l1} and SSIM {ssim} for {scene}"));
    let text = vec![
        format!(
            "With a plane at infinity every mode has to draw the scene as it is. The paper reports 0 with its strategy, and {} \
             when every Gaussian is traced.",
            paper.join(", ")
        ),
        nearest(results),
    ];
    Section {
        id: "ablation",
        title: "Ablation: a plane at infinity",
        text,
        body: html(&tables),
        tables,
    }
}

/// Says which reading of tracing everything comes near the paper's numbers.
fn nearest(results: &Results) -> String {
    let mut found = Vec::new();
    for (scene, rows) in &results.ablation {
        let traced = rows.iter().filter(|row| row.what.starts_with("rara, all"));
        for (paper, l1, _) in WITHOUT {
            let apart = |row: &&ablation::AblationRow| ((row.l1.max(1e-9)) / l1).ln().abs();
            let best = traced.clone().min_by(|a, b| apart(a).total_cmp(&apart(b)));
            found.extend(
                best.map(|row| format!("{scene} beside {paper}: {} (L1 {:.3})", row.what, row.l1)),
            );
        }
    }
    format!(
        "Every reading that keeps what misses the ellipsoid, or decides by the side of its densest point, changes nothing. One \
         that drops it removes from every splat what lies outside the ellipsoid; needles thinner than a pixel are widened by \
         the low-pass, so that most of their rays miss even at 3 sigma. The reading whose L1 is nearest to the paper's, scene \
         by scene: {}.",
        found.join("; ")
    )
}

/// Cases whose pictures the page shows.
const SHOWN: usize = 4;

fn maps_section(folder: &Path, results: &Results) -> Result<Section> {
    let faces = results
        .maps
        .iter()
        .filter(|maps| maps.case.ends_with(", face"));
    let step = (results.scenes.len() / SHOWN).max(1);
    let mut body = String::new();
    for shown in faces.step_by(step).take(SHOWN) {
        body += &pictures(folder, shown)?;
    }
    let scale = data_uri(&maps::scale(400, 12).to_png()?);
    let labels = ["0.1", "1", "10", "100 of 255"].map(|label| format!("<span>{label}</span>"));
    body += &format!(
        "<div class=\"scale\"><img src=\"{scale}\" alt=\"the scale of the maps\">{}</div>\n",
        labels.concat()
    );
    Ok(Section {
        id: "maps",
        title: "Error maps",
        text: vec![
            "Each pixel of a map has the largest difference of a channel from the truth, on a logarithmic scale; white is less \
             than 0.1 of 255. Below are the square in which mode hard is farthest from the truth, magnified, and its map. The folder \
             maps has these pictures of every case."
                .into(),
        ],
        body,
        tables: Vec::new(),
    })
}

fn pictures(folder: &Path, maps: &Maps) -> Result<String> {
    let mut text = format!(
        "<h3>{}</h3>\n<div class=\"pictures\">\n",
        escaped(&maps.case)
    );
    for row in 0..4 {
        for (way, files) in &maps.pictures {
            let picture = match &files[row] {
                Some(file) => {
                    let source = embedded(folder, file)?;
                    format!("<img src=\"{source}\" alt=\"{}\">", escaped(file))
                }
                None => String::new(),
            };
            let caption = if row == 0 {
                escaped(way)
            } else {
                String::new()
            };
            let _ = writeln!(
                text,
                "<figure>{picture}<figcaption>{caption}</figcaption></figure>"
            );
        }
    }
    Ok(text + "</div>\n")
}

fn embedded(folder: &Path, file: &str) -> Result<String> {
    let path = folder.join(file);
    let bytes = std::fs::read(&path).map_err(|e| {
        Error::Invalid(format!(
            "{}: {e}; remove the folder's parts to draw it again",
            path.display()
        ))
    })?;
    Ok(data_uri(&bytes))
}

fn data_uri(png: &[u8]) -> String {
    format!("data:image/png;base64,{}", STANDARD.encode(png))
}

fn qualities_section(results: &Results) -> Section {
    let outcomes = &results.outcomes;
    let tables = vec![qualities::means(outcomes), qualities::tests(outcomes)];
    let mut body = html(&tables);
    body += &charts([
        qualities::radar(outcomes).svg(),
        qualities::heat_map(outcomes, "exact").svg(),
    ]);
    body += &charts(
        qualities::violins(outcomes)
            .iter()
            .map(|violin| violin.svg()),
    );
    Section {
        id: "qualities",
        title: "The six perceptual qualities, measured",
        text: vec![format!(
            "{} from {}. A defect is 0 where a picture is the truth.",
            counted(outcomes.len(), "case"),
            counted(results.scenes.len(), "scene")
        )],
        body,
        tables,
    }
}

fn choices_section(results: &Results) -> Section {
    let mut tables: Vec<Table> = Vec::new();
    let mut body = charts(
        results
            .choices
            .iter()
            .map(|(_, choices)| choices.chart.clone()),
    );
    for (scene, choices) in &results.choices {
        for table in &choices.tables {
            let mut table = table.clone();
            table.title = format!("{scene}: {}", table.title);
            tables.push(table);
        }
        for why in &choices.refused {
            let _ = writeln!(
                body,
                "<p>Not timed, because its picture is wrong: {}</p>",
                escaped(why)
            );
        }
    }
    body += &charts([fronts(results).svg()]);
    body += &html(&tables);
    Section {
        id: "pareto",
        title: "Run time against error",
        text: vec![
            "Each point is a mode or a choice of precision. The line joins those that nothing else beats in both. The second chart \
             has the modes and presets of all scenes."
                .into(),
        ],
        body,
        tables,
    }
}

/// The modes and presets of all timed scenes in one chart: time as a ratio to mode `none`, error against the truth.
fn fronts(results: &Results) -> Plot {
    const NAMES: [&str; 5] = ["hard", "rara", "exact", "preset fast", "preset exact"];
    let of_scene = |(scene, choices): &(String, Choices)| {
        let value = |name: &str, column: &str| choices.tables.first()?.number(name, column);
        let whole = value("none", "ms");
        let point = |name: &str| {
            let time = value(name, "ms")? / whole?;
            Some((time, value(name, "L1")?, name.to_owned()))
        };
        Points {
            name: scene.clone(),
            points: NAMES.into_iter().filter_map(point).collect(),
        }
    };
    Plot {
        title: "Modes and presets, all scenes".into(),
        x: Axis::log("time per frame over that of the whole scene"),
        y: Axis::log("L1 against the truth (of 255)"),
        series: results.choices.iter().map(of_scene).collect(),
        joined: false,
        front: Vec::new(),
    }
}

fn series_section(results: &Results) -> Section {
    let tables = vec![series::table(&results.series)];
    let all = results.series.iter().flat_map(series::charts);
    let body = charts(all.map(|chart| chart.svg())) + &html(&tables);
    Section {
        id: "series",
        title: "How cost and error grow",
        text: Vec::new(),
        body,
        tables,
    }
}
