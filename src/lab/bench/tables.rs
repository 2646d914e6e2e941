//! What was measured, as tables.

use rara_base::counted::counted;

use super::judge::Measures;
use super::report::BenchReport;
use crate::table::{Cell, Table};

/// The columns of a picture's errors after L1.
const ERRORS: [&str; 6] = ["SSIM", "band SSIM", "leak", "loss", "pops", "beyond"];

fn errors(m: &Measures) -> [Cell; 6] {
    [
        Cell::Fixed(m.ssim, 5),
        m.band_ssim
            .map_or(Cell::Number(None), |ssim| Cell::Fixed(ssim, 5)),
        m.leak.into(),
        m.loss.into(),
        m.popping.worst.into(),
        m.popping.worst_beyond.into(),
    ]
}

impl BenchReport {
    pub fn tables(&self) -> Vec<Table> {
        let mut tables = vec![choices(self), stages(self), ways(self)];
        if !self.shapes.is_empty() {
            tables.push(shapes(self));
        }
        tables
    }

    /// The tables, and what was not timed.
    pub fn markdown(&self) -> String {
        let tables: Vec<_> = self.tables().iter().map(Table::markdown).collect();
        let refused = self.refused.iter();
        let refused =
            refused.map(|why| format!("\nNot timed, because its picture is wrong: {why}\n"));
        tables.join("\n") + &refused.collect::<String>()
    }
}

fn choices(report: &BenchReport) -> Table {
    let [width, height] = report.size;
    let note = format!(
        "{}, {width}x{height}; {}; {} ({}). ms: the sum of each stage's least of {}, one of each choice in \
         turn, and the median frame. CPU: the time of this process on all cores, least and median. Errors are those against \
         the exact cut in double precision, on a scale of 0 to 255; band SSIM is over the {:.2} % of the picture in which \
         the way of cutting shows. Pops: the largest change of a pixel in {} through 1/300 of the scene each; \
         beyond: how much of it the truth does not do. Front: no other choice is both faster and nearer.",
        report.scene,
        counted(report.gaussians, "Gaussian"),
        report.device,
        report.driver,
        counted(report.frames, "frame"),
        100.0 * report.band_share,
        counted(report.steps, "step"),
    );
    let columns = ["choice", "flags", "ms", "median", "CPU", "median CPU", "L1"];
    let columns = columns
        .into_iter()
        .chain(ERRORS)
        .chain(["own PSNR", "front"]);
    let mut table = Table::new("Run time against error", note, columns);
    for row in &report.rows {
        let (m, t) = (&row.measures, &row.times);
        let first: [Cell; 7] = [
            row.name.into(),
            row.flags.into(),
            t.ms_min.into(),
            t.ms.into(),
            t.cpu_ms_min.into(),
            t.cpu_ms.into(),
            m.l1.into(),
        ];
        let front = if row.undominated { "yes" } else { "" };
        let last = [m.twin_psnr.into(), front.into()];
        table.row(first.into_iter().chain(errors(m)).chain(last));
    }
    table
}

fn stages(report: &BenchReport) -> Table {
    let table = Table::new("Stages", "The least of the frames, ms.", ["choice"]);
    table.pivot(report.rows.iter().map(|row| {
        let passes = row.times.passes.iter();
        let passes = passes.map(|pass| (pass.name.as_str(), pass.ms_min));
        (vec![row.name.into()], passes.collect())
    }))
}

fn ways(report: &BenchReport) -> Table {
    let columns = ["size", "mode", "L1", "exact is nearer by"];
    let columns = columns.into_iter().chain(ERRORS);
    let mut table = Table::new("Ways of cutting against the truth", "", columns);
    for line in &report.ways {
        let [width, height] = line.size;
        let first = [
            format!("{width}x{height}").into(),
            line.name.into(),
            line.measures.l1.into(),
            line.l1_over_exact.into(),
        ];
        table.row(first.into_iter().chain(errors(&line.measures)));
    }
    table
}

/// Ratios are of costs.
fn shapes(report: &BenchReport) -> Table {
    let note =
        "Costs (ms) and errors of mode exact; the last but one columns are those of mode hard.";
    let columns = [
        "region",
        "cut",
        "cost",
        "/ plane",
        "/ hard",
        "L1",
        "own PSNR",
        "hard: cost",
        "hard: L1",
        "as --clip-expr",
    ];
    let mut table = Table::new("Shapes through the same point of the scene", note, columns);
    let plane = report
        .shapes
        .first()
        .map_or(f64::NAN, |plane| plane.exact.cost);
    for line in &report.shapes {
        table.row([
            line.name.into(),
            line.cutoff.into(),
            line.exact.cost.into(),
            (line.exact.cost / plane).into(),
            (line.exact.cost / line.hard.cost).into(),
            line.l1.into(),
            line.twin_psnr.into(),
            line.hard.cost.into(),
            line.hard_l1.into(),
            line.region.clone().into(),
        ]);
    }
    table
}
