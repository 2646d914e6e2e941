//! From a row of raw numbers to a Gaussian: units converted, unusable rows dropped, both counted.

use std::ops::Range;

use bytemuck::allocation::try_zeroed_vec;
use glam::{DVec3, DVec4, Quat, Vec3};

use super::failure::Failure;
use super::gaussians::MAX_SH_DEGREE;
use super::parts::keep;
use super::scene_file::SceneFile;
use super::{Format, GaussianArrays, Gaussians, LoadReport, Property, sh_coefficients};
use rara_base::counted::counted;
use rara_base::parallel::in_parallel;

/// Slots of a row, see [`FIXED`]: the scales, by default their logarithms.
pub(super) const SCALES: usize = 3;
/// The quaternion, w first.
pub(super) const ROTATION: usize = 6;
/// The opacity, by default its logit.
pub(super) const OPACITY: usize = 10;
/// From here on the spherical harmonics as `[coefficient][r, g, b]`.
pub(super) const SH: usize = 11;
/// Slots of a row at degree 3.
pub(super) const SLOTS: usize = SH + 48;

/// What every scene has, in the order of the slots and by the names of a `.ply`: `FIXED[slot]`.
pub(super) const FIXED: [&str; SH + 3] = [
    "x", "y", "z", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3", "opacity",
    "f_dc_0", "f_dc_1", "f_dc_2",
];

/// The numbers of one Gaussian as the file has them, by slot; slots that are not in use stay zero.
pub(super) type GaussianRow = [f64];

/// How a file stores what can be stored in two ways.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ColumnForm {
    /// Scales as logarithms, opacities as logits.
    Logarithms,
    /// Scales as logarithms, opacities from 0 to 1.
    LogScales,
    /// Scales as they are, opacities as logits.
    PlainScales,
    /// Both as they are.
    Plain,
}

impl ColumnForm {
    /// That of a file that stores one or the other as it is.
    pub(super) fn plain(scales: bool, opacities: bool) -> Self {
        match (scales, opacities) {
            (false, false) => Self::Logarithms,
            (false, true) => Self::LogScales,
            (true, false) => Self::PlainScales,
            (true, true) => Self::Plain,
        }
    }

    fn has_logarithms(self) -> bool {
        matches!(self, Self::Logarithms | Self::LogScales)
    }

    fn has_logits(self) -> bool {
        matches!(self, Self::Logarithms | Self::PlainScales)
    }
}

/// Rows that one thread makes Gaussians of at a time: few enough to stay in its cache.
pub(super) const ROWS: usize = 1 << 10;

/// Collects rows into [`Gaussians`].
pub(super) struct Assembler {
    /// With a place for each row.
    arrays: GaussianArrays,
    /// The properties that were asked for, whose slots follow on those of a Gaussian.
    properties: Vec<Property>,
    pub(super) report: LoadReport,
    /// The numbers of the rows that were dropped, which ascend.
    pub(super) dropped: Vec<u64>,
    stored: ColumnForm,
}

/// Rows that follow each other, and the places of the Gaussians that they become.
pub(super) struct Rows<'a> {
    /// The number of the first.
    first: u64,
    /// How many have been pushed.
    pushed: usize,
    positions: &'a mut [Vec3],
    scales: &'a mut [Vec3],
    rotations: &'a mut [Quat],
    opacities: &'a mut [f32],
    sh: &'a mut [f32],
    sh_degree: u32,
    origin: [f64; 3],
    properties: Vec<(&'a mut [f64], bool)>,
    report: LoadReport,
    dropped: Vec<u64>,
    stored: ColumnForm,
}

impl Assembler {
    /// Room for exactly `count` Gaussians and their values of `properties`; the caller has checked that the file is big
    /// enough for them. `None` if the memory can't be had.
    pub(super) fn with_room(
        count: u64,
        sh_degree: u32,
        mut properties: Vec<Property>,
    ) -> Option<Self> {
        let room = usize::try_from(count).ok()?;
        for property in &mut properties {
            property.values = try_zeroed_vec(room).ok()?;
        }
        Some(Self {
            arrays: GaussianArrays::zeroed(room, sh_degree)?,
            properties,
            report: LoadReport::default(),
            dropped: Vec::new(),
            stored: ColumnForm::Logarithms,
        })
    }

    /// The same for centres about an origin, from which they are counted.
    pub(super) fn about(mut self, origin: DVec3) -> Self {
        self.arrays.origin = origin;
        self
    }

    /// The same for rows that store scales and opacities in another way.
    pub(super) fn stored(mut self, stored: ColumnForm) -> Self {
        self.stored = stored;
        self
    }

    /// How many rows there are, those included that are dropped.
    pub(super) fn rows(&self) -> u64 {
        self.arrays.positions.len() as u64
    }

    /// Makes each row of its number, on all cores. Rows come with zeros, also for the properties.
    pub(super) fn make(
        mut self,
        make: impl Fn(usize, &mut [f64]) -> Result<(), Failure> + Sync,
    ) -> Result<Self, Failure> {
        let slots = SLOTS + self.properties.len();
        let read = |_| Ok(());
        self.read(ROWS, read, |(), rows| {
            let mut row = vec![0.0; slots];
            for number in rows.numbers() {
                row.fill(0.0);
                make(number as usize, &mut row)?;
                rows.push(&row);
            }
            Ok(())
        })?;
        Ok(self)
    }

    /// Takes all rows, `each` at a time: `read` reads what has the rows of these numbers, one after the other on the calling
    /// thread, and `parse` pushes them, on any.
    pub(super) fn read<T: Send>(
        &mut self,
        each: usize,
        mut read: impl FnMut(Range<u64>) -> Result<T, Failure>,
        parse: impl Fn(T, &mut Rows<'_>) -> Result<(), Failure> + Sync,
    ) -> Result<(), Failure> {
        let mut is_read = true;
        let tasks = self.split(each).map_while(|rows| {
            let read = is_read.then(|| read(rows.numbers()))?;
            is_read = read.is_ok();
            Some((rows, read))
        });
        let parsed = in_parallel(tasks, |(mut rows, read)| {
            parse(read?, &mut rows)?;
            Ok::<_, Failure>((rows.report, rows.dropped))
        });
        for part in parsed {
            let (report, dropped) = part?;
            self.report.append(report, 0);
            self.dropped.extend(dropped);
        }
        Ok(())
    }

    /// The places of all rows, `each` at a time.
    fn split(&mut self, each: usize) -> impl Iterator<Item = Rows<'_>> {
        let (arrays, stored) = (&mut self.arrays, self.stored);
        let (sh_degree, origin) = (arrays.sh_degree, arrays.origin.to_array());
        let properties = self.properties.iter_mut();
        let mut properties: Vec<_> = properties
            .map(|property| (property.values.chunks_mut(each), property.single))
            .collect();
        let scales = arrays.scales.chunks_mut(each);
        let rotations = arrays.rotations.chunks_mut(each);
        let opacities = arrays.opacities.chunks_mut(each);
        let sh = arrays.sh.chunks_mut(each * 3 * sh_coefficients(sh_degree));
        let positions = arrays.positions.chunks_mut(each);
        let places = positions.zip(scales).zip(rotations).zip(opacities).zip(sh);
        (0..).step_by(each).zip(places).map(
            move |(first, ((((positions, scales), rotations), opacities), sh))| Rows {
                first,
                pushed: 0,
                positions,
                scales,
                rotations,
                opacities,
                sh,
                sh_degree,
                origin,
                properties: properties
                    .iter_mut()
                    .map(|(values, single)| (values.next().unwrap_or_default(), *single))
                    .collect(),
                report: LoadReport::default(),
                dropped: Vec::new(),
                stored,
            },
        )
    }

    /// The scene and the properties, and the report on what was done to them.
    pub(super) fn finish(mut self) -> (SceneFile, Vec<Property>) {
        if !self.dropped.is_empty() {
            let mut dropped = self.dropped.iter().peekable();
            let is_kept = |row: &u32| dropped.next_if_eq(&&u64::from(*row)).is_none();
            let kept: Vec<u32> = (0..self.arrays.positions.len() as u32)
                .filter(is_kept)
                .collect();
            self.arrays.keep(&kept);
            for property in &mut self.properties {
                keep(&mut property.values, &kept, 1);
            }
        }
        let loaded = SceneFile {
            gaussians: Gaussians::of_fitting(self.arrays),
            report: self.report,
            format: Format::Ply,
            antialiased: None,
            annotations: None,
            others: Vec::new(),
            up: None,
        };
        (loaded, self.properties)
    }
}

impl Rows<'_> {
    /// Their numbers.
    pub(super) fn numbers(&self) -> Range<u64> {
        self.first..self.first + self.positions.len() as u64
    }

    /// Takes the next row.
    pub(super) fn push(&mut self, row: &GaussianRow) {
        let at = self.pushed;
        let element = self.first + at as u64;
        self.pushed += 1;
        let degree = self.sh_degree;
        let numbers = 3 * sh_coefficients(degree);
        let used = &row[..SH + numbers];
        let mut single = [0.0; SLOTS];
        let single = &mut single[..used.len()];
        let mut is_finite = true;
        for (slot, (to, &value)) in single.iter_mut().zip(used).enumerate() {
            *to = (value - self.origin.get(slot).unwrap_or(&0.0)) as f32;
            is_finite &= to.is_finite();
        }
        let unusable =
            |(slot, value): (usize, &f32)| !(value.is_finite() || self.is_limit(slot, *value));
        if !is_finite && let Some(slot) = single.iter().enumerate().position(unusable) {
            self.drop_row(element, || {
                let value = row[slot];
                let beyond = if value.is_finite() {
                    ", beyond single precision"
                } else {
                    ""
                };
                format!("{} is {value:e}{beyond}", slot_name(slot, degree))
            });
            return;
        }
        let stored = [row[3], row[4], row[5]];
        let scale = match self.stored.has_logarithms() {
            true => stored.map(|log| log.exp() as f32),
            false => stored.map(|scale| scale.abs() as f32),
        };
        if let Some(axis) = scale.iter().position(|s| !s.is_finite()) {
            self.drop_row(element, || {
                format!(
                    "exp(scale_{axis}) is beyond single precision: scale_{axis} is {}",
                    row[3 + axis]
                )
            });
            return;
        }
        let rotation = unit(DVec4::new(row[7], row[8], row[9], row[6]));
        // A row counts once, however much of it is repaired.
        if rotation.is_none() {
            self.report.repair_element(element, || {
                "its rotation was all zeros, now the identity".into()
            });
        } else if let Some(slot) =
            (SCALES..=OPACITY).find(|&slot| self.is_repaired(slot, row[slot]))
        {
            self.report.repair_element(element, || {
                let becomes = if slot == OPACITY { "opacity" } else { "scale" };
                let value = match row[slot] {
                    value if slot < ROTATION && value.is_finite() => value.abs(),
                    value if value > 0.0 => 1.0,
                    _ => 0.0,
                };
                format!(
                    "{} is {:e}, taken as the {becomes} {value}",
                    slot_name(slot, degree),
                    row[slot]
                )
            });
        }
        self.positions[at] = Vec3::from_slice(&single[..3]);
        self.scales[at] = Vec3::from_array(scale);
        self.rotations[at] = rotation.unwrap_or(Quat::IDENTITY);
        self.opacities[at] = match self.stored.has_logits() {
            true => (1.0 / (1.0 + (-row[OPACITY]).exp())) as f32,
            false => row[OPACITY].clamp(0.0, 1.0) as f32,
        };
        self.sh[at * numbers..][..numbers].copy_from_slice(&single[SH..]);
        for ((values, single), &value) in self.properties.iter_mut().zip(&row[SLOTS..]) {
            // Text can have more digits than what it stands for.
            values[at] = match single {
                true => f64::from(value as f32),
                false => value,
            };
        }
    }

    fn drop_row(&mut self, row: u64, reason: impl FnOnce() -> String) {
        self.dropped.push(row);
        self.report.drop_element(row, reason);
    }

    /// True when an infinite value is the exact stored form of a sensible one: editors write the logit of opacity 1 as
    /// infinity, and the logarithm of scale 0 as its negative.
    fn is_limit(&self, slot: usize, value: f32) -> bool {
        match slot {
            OPACITY => self.stored.has_logits() && value.is_infinite(),
            SCALES..ROTATION => self.stored.has_logarithms() && value == f32::NEG_INFINITY,
            _ => false,
        }
    }

    /// True for what is put right: such an infinity, a negative scale, an opacity beyond 0 and 1.
    fn is_repaired(&self, slot: usize, value: f64) -> bool {
        let is_wrong = match slot {
            OPACITY => !self.stored.has_logits() && !(0.0..=1.0).contains(&value),
            SCALES..ROTATION => !self.stored.has_logarithms() && value < 0.0,
            _ => false,
        };
        is_wrong || self.is_limit(slot, value as f32)
    }
}

/// The property a slot was read from, for messages; formats without properties call them the same.
pub(super) fn slot_name(slot: usize, sh_degree: u32) -> String {
    if slot < FIXED.len() {
        return FIXED[slot].into();
    }
    let (coefficient, channel) = ((slot - SH) / 3 - 1, (slot - SH) % 3);
    format!(
        "f_rest_{}",
        channel * (sh_coefficients(sh_degree) - 1) + coefficient
    )
}

/// A unit quaternion of its three smaller parts, in their order, and the place of the largest, which is positive.
pub(super) fn unit_quaternion(largest: usize, others: [f64; 3]) -> [f64; 4] {
    let rest: f64 = others.iter().map(|part| part * part).sum();
    let mut all = [0.0; 4];
    let mut next = others.into_iter();
    for (place, part) in all.iter_mut().enumerate() {
        *part = match place == largest {
            true => (1.0 - rest).max(0.0).sqrt(),
            false => next.next().unwrap_or_default(),
        };
    }
    all
}

/// The quaternion x, y, z, w at length one; `None` for zero. Dividing by the largest component first keeps the
/// squares of tiny and huge ones in range.
fn unit(q: DVec4) -> Option<Quat> {
    let largest = q.abs().max_element();
    if largest == 0.0 {
        return None;
    }
    let q = (q / largest).normalize();
    Some(Quat::from_vec4(q.as_vec4()))
}

/// Refuses more Gaussians than there are numbers for.
pub(super) fn check_count(count: u64) -> Result<(), String> {
    match count > u64::from(u32::MAX) {
        false => Ok(()),
        true => Err(format!(
            "{} are more than the {} that can be numbered; split the file",
            counted(count, "Gaussian"),
            u32::MAX
        )),
    }
}

/// An assembler with room for so many Gaussians, for which the file has bytes. Of spherical harmonics of degree 4 it has room for
/// those that are drawn, and says so.
pub(super) fn room(count: u64, degree: u32, stored: ColumnForm) -> Result<Assembler, Failure> {
    let mut assembler = room_with(count, degree.min(MAX_SH_DEGREE), stored, Vec::new())?;
    if degree > MAX_SH_DEGREE {
        assembler.report.note(DEGREE_4.into());
    }
    Ok(assembler)
}

/// The same with room for properties, whose slots follow on those of a Gaussian.
pub(super) fn room_with(
    count: u64,
    sh_degree: u32,
    stored: ColumnForm,
    properties: Vec<Property>,
) -> Result<Assembler, Failure> {
    check_count(count)?;
    let assembler = Assembler::with_room(count, sh_degree, properties);
    let assembler = assembler.ok_or_else(|| Failure::Memory(counted(count, "Gaussian")))?;
    Ok(assembler.stored(stored))
}

/// The note on spherical harmonics of degree 4, which are drawn to degree 3.
pub(super) const DEGREE_4: &str =
    "left out the spherical harmonics of degree 4, which are not drawn";

/// The degree of spherical harmonics, 0 to 4, of which a Gaussian has so many numbers above degree 0.
pub(super) fn degree_of(rest: usize) -> Option<u32> {
    (0..=4).find(|&degree| 3 * (sh_coefficients(degree) - 1) == rest)
}

#[cfg(test)]
mod tests;
