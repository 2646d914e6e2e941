//! The measurements as Markdown, CSV and JSON.

use std::fmt::Write as _;
use std::path::Path;

use rara::Result;

use super::{Measures, Report, Row, output};

/// Writes all three into a folder.
pub(super) fn write(folder: &Path, report: &Report) -> Result<()> {
    output::text(&folder.join("bench.md"), &markdown(report))?;
    output::text(&folder.join("bench.csv"), &csv(report))?;
    let json = serde_json::to_string_pretty(report).expect("the report has string keys only");
    output::text(&folder.join("bench.json"), &(json + "\n"))
}

/// The tables for people.
pub(super) fn markdown(report: &Report) -> String {
    let mut text = String::new();
    let [width, height] = report.size;
    let _ = writeln!(
        text,
        "# {}, {width}x{height}\n\n{}; {} ({}). ms: the sum of each stage's least of {}, one of each choice in turn; the median frame; and the least and median time of this process on \
         all cores. \
         Errors against the exact cut in double precision, of 255; band SSIM over the {:.2} % of the picture in which \
         the way of cutting shows. Popping: largest change of a pixel in a step of {} through a 300th of the scene each, \
         of 255, and of that what the truth does not do. **Bold**: nothing else is both faster and nearer.\n",
        report.scene,
        output::counted(report.gaussians as u64, "Gaussian"),
        report.device,
        report.driver,
        output::counted(report.frames.into(), "frame"),
        100.0 * report.band_share,
        report.steps,
    );
    text += "| choice | flags | ms | median | CPU | median | L1 | SSIM | band SSIM | leak | loss | pops | beyond | own PSNR |\n";
    text += "|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n";
    for row in &report.rows {
        let Row {
            name,
            flags,
            measures: m,
            times: t,
            undominated,
        } = row;
        let star = if *undominated { "**" } else { "" };
        let _ = writeln!(
            text,
            "| {star}{name}{star} | `{flags}` | {:.1} | {:.1} | {:.1} | {:.1} | {} | {} | {:.1} |",
            t.ms_min,
            t.ms,
            t.cpu_ms_min,
            t.cpu_ms,
            small(m.l1),
            other_errors(m),
            m.twin_psnr,
        );
    }
    text = text.replace("| `` |", "| |");
    for refused in &report.refused {
        let _ = writeln!(text, "\nNot timed, because its picture is wrong: {refused}");
    }
    stages(&mut text, report);
    paper(&mut text, report);
    shapes(&mut text, report);
    let best = report.rows.iter().filter(|row| row.undominated);
    let mut best: Vec<&Row> = best.collect();
    best.sort_by(|a, b| a.times.cost.total_cmp(&b.times.cost));
    let best = best.iter().map(|r| {
        format!(
            "{} ({:.1} ms, L1 {})",
            r.name,
            r.times.cost,
            small(r.measures.l1)
        )
    });
    let _ = writeln!(
        text,
        "\nUndominated, the fastest first: {}.",
        best.collect::<Vec<_>>().join("; ")
    );
    text
}

/// The columns of a picture's errors after L1: SSIM, band SSIM, leak, loss, and both numbers of popping.
fn other_errors(m: &Measures) -> String {
    format!(
        "{:.5} | {} | {} | {} | {:.1} | {:.2}",
        m.ssim,
        optional(m.band_ssim),
        small(m.leak),
        small(m.loss),
        m.popping.worst,
        m.popping.worst_beyond,
    )
}

fn stages(text: &mut String, report: &Report) {
    let mut names = Vec::new();
    for pass in report.rows.iter().flat_map(|row| &row.times.passes) {
        if !names.contains(&pass.name) {
            names.push(pass.name);
        }
    }
    let _ = writeln!(
        text,
        "\n## Stages, least of the frames, ms\n\n| choice | {} |",
        names.join(" | ")
    );
    let _ = writeln!(text, "|---|{}", "---:|".repeat(names.len()));
    for row in &report.rows {
        let _ = write!(text, "| {} |", row.name);
        for name in &names {
            match row.times.passes.iter().find(|pass| pass.name == *name) {
                Some(pass) => drop(write!(text, " {:.2} |", pass.ms_min)),
                None => *text += " |",
            }
        }
        *text += "\n";
    }
}

fn paper(text: &mut String, report: &Report) {
    *text += "\n## Ways of cutting against the truth\n\n\
        | size | mode | L1 | exact is nearer by | SSIM | band SSIM | leak | loss | pops | beyond |\n\
        |---|---|---:|---:|---:|---:|---:|---:|---:|---:|\n";
    for line in &report.paper {
        let m = &line.measures;
        let _ = writeln!(
            text,
            "| {}x{} | {} | {} | {:.1} | {} |",
            line.size[0],
            line.size[1],
            line.name,
            small(m.l1),
            line.l1_over_exact,
            other_errors(m),
        );
    }
}

/// Shapes, where they were measured. Ratios are of costs.
fn shapes(text: &mut String, report: &Report) {
    let Some(plane) = report.shapes.first() else {
        return;
    };
    *text += "\n## Shapes through the same point of the scene\n\n\
        Costs and errors of mode exact; the last columns are mode hard's.\n\n\
        | region | cut | cost | / plane | / hard | L1 | own PSNR | hard: cost | L1 | as `--clip-expr` |\n\
        |---|---:|---:|---:|---:|---:|---:|---:|---:|---|\n";
    for line in &report.shapes {
        let _ = writeln!(
            text,
            "| {} | {} | {:.1} | {:.2} | {:.2} | {} | {:.1} | {:.1} | {} | `{}` |",
            line.name,
            line.cutoff,
            line.exact.cost,
            line.exact.cost / plane.exact.cost,
            line.exact.cost / line.hard.cost,
            small(line.l1),
            line.twin_psnr,
            line.hard.cost,
            small(line.hard_l1),
            line.region,
        );
    }
}

fn csv(report: &Report) -> String {
    let mut text = String::from(
        "choice,flags,ms_min,ms,wall_ms,cpu_ms,cpu_ms_min,l1,ssim,band_ssim,max,leak,loss,\
         pop_worst,pop_mean,pop_worst_beyond,pop_mean_beyond,twin_psnr,undominated\n",
    );
    for row in &report.rows {
        let (m, t, p) = (&row.measures, &row.times, &row.measures.popping);
        let numbers = [
            t.ms_min,
            t.ms,
            t.wall_ms,
            t.cpu_ms,
            t.cpu_ms_min,
            m.l1,
            m.ssim,
        ];
        let more = [
            m.max,
            m.leak,
            m.loss,
            p.worst,
            p.mean,
            p.worst_beyond,
            p.mean_beyond,
            m.twin_psnr,
        ];
        let list = |numbers: &[f64]| {
            let texts: Vec<_> = numbers.iter().map(|number| number.to_string()).collect();
            texts.join(",")
        };
        let band = m.band_ssim.map_or(String::new(), |v| v.to_string());
        let _ = writeln!(
            text,
            "\"{}\",\"{}\",{},{band},{},{}",
            row.name,
            row.flags,
            list(&numbers),
            list(&more),
            row.undominated
        );
    }
    text
}

fn optional(value: Option<f64>) -> String {
    value.map_or("-".into(), |value| format!("{value:.5}"))
}

/// Two significant digits, however small the value: 0.00031, 0.12, 3.4, 25.
fn small(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let digits = (1 - value.abs().log10().floor() as i32).clamp(0, 9);
    format!("{value:.*}", digits as usize)
}

#[cfg(test)]
mod tests {
    use super::small;

    #[test]
    fn two_digits_count() {
        let shown = [0.0, 0.000_312, 0.118, 3.44, 25.2, 731.0].map(small);
        assert_eq!(shown, ["0", "0.00031", "0.12", "3.4", "25", "731"]);
    }
}
