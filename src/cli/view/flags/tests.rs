use super::*;
use crate::clip::ClipArgs;
use crate::settings::SettingsArgs;
use clap::{Args as _, FromArgMatches as _};
use glam::{DVec2, DVec3};
use rara::{Camera, Plane, Precision, Settings};
use rara_view::viewer::{ClipEditor, Clips, FaceView, GripAction};

/// A shell's words: blanks are between them, but not within single quotes.
fn words(line: &str) -> Vec<String> {
    let (mut words, mut word, mut is_quoted) = (Vec::new(), None::<String>, false);
    for letter in line.chars() {
        match letter {
            '\'' => {
                is_quoted = !is_quoted;
                word.get_or_insert_default();
            }
            ' ' if !is_quoted => words.extend(word.take()),
            letter => word.get_or_insert_default().push(letter),
        }
    }
    words.extend(word);
    words
}

/// The clip and the settings that flags mean.
fn meant(flags: &str) -> (Clips, Settings) {
    let command = clap::Command::new("rara").no_binary_name(true);
    let command = <SettingsArgs>::augment_args(ClipArgs::augment_args(command));
    let matches = command.try_get_matches_from(words(flags));
    let matches = matches.unwrap_or_else(|error| panic!("{flags}: {error}"));
    let settings = <SettingsArgs>::from_arg_matches(&matches).unwrap();
    let clip = ClipArgs::from_arg_matches(&matches).unwrap();
    let regions = clip.meant().unwrap();
    let expressions = regions.expressions(&rara::Scene::default()).unwrap();
    let cut = ClipEditor::new(expressions, regions.op(), DVec3::ZERO);
    let clips = Clips::new(cut, &[], DVec3::ZERO);
    (clips, settings.meant())
}

/// The flags that are written for the clip and the settings of `typed`.
fn written(typed: &str) -> String {
    let (clips, settings) = meant(typed);
    flags(&shown(camera(), &clips, &settings))
}

fn shown<'a>(camera: Camera, clips: &'a Clips, settings: &'a Settings) -> Shown<'a> {
    Shown {
        camera,
        clips,
        settings,
        faces: FaceView::default(),
        notes: &[],
    }
}

fn camera() -> Camera {
    let eye = DVec3::new(0.3, -0.2, -4.0);
    Camera::look_at(eye, DVec3::ZERO, DVec3::NEG_Y, 50.0, (640, 480)).unwrap()
}

#[test]
fn what_made_the_layers_comes_before_what_changed_them() {
    let (clips, settings) = meant("--mode none");
    let notes = typed(&[("--select", "bone=label in 3"), ("--place", "a=1,2,3")]);
    let shown = Shown {
        notes: &notes,
        ..shown(camera(), &clips, &settings)
    };
    let written = "--select='bone=label in 3' --place=a=1,2,3 --mode none";
    assert_eq!(flags(&shown), written);
}

#[test]
fn marks_of_cut_faces_are_said_and_slices_noted() {
    let (clips, settings) = meant("--clip plane:0,0,1,0 --mode exact");
    let mut shown = shown(camera(), &clips, &settings);
    (shown.faces.edge, shown.faces.rim) = (true, true);
    let written = "--clip plane:0,0,1,0 --outline=1,0.9,0.2 --rim=1,0.5,0.1 --mode exact";
    assert_eq!(flags(&shown), written);
    assert_eq!(notes(&shown).count(), 0);
    shown.faces.slice = true;
    assert_eq!(flags(&shown), "--clip plane:0,0,1,0 --mode exact");
    let lines = lines(&shown);
    assert!(lines.contains("leave out the slice"), "{lines}");
}

#[test]
fn the_planes_of_a_camera_are_said_wherever_the_rest_of_it_is() {
    let (clips, settings) = meant("--mode exact");
    let cut = camera().clip_near(Some(1.25)).clip_far(Some(7.5));
    let planes = "--clip-near 1.25 --clip-far 7.5 --mode exact";
    assert_eq!(flags(&shown(cut, &clips, &settings)), planes);
    for line in [cut, cut.cx(300.0)].map(|camera| lines(&shown(camera, &clips, &settings))) {
        let first = line.lines().next().unwrap();
        assert!(first.ends_with(planes), "{line}");
        assert_eq!(line.matches("--clip-near").count(), 1, "{line}");
    }
}

#[test]
fn what_was_typed_is_what_draws_it_again() {
    for typed in [
        "--mode exact",
        "--clip plane:0,0,-1,0.25 --mode hard",
        "--clip sphere:0,0,0,1 --clip '!box:0,0,0,1,1,1,0.5,0.5,0.5,0.5' --clip-op or --mode hard",
        "--clip cone:0,0,0,1,1,1,0.5 --clip-expr 'any(slab:0,0,1,0,2, not(capsule:0,0,0,1,1,1,0.5))' --mode exact",
        "--clip plane:0,0,1,0.1 --clip plane:1,0,0,-2 --clip-op or --mode none",
        "--mode rara --decay depth --sigma 1.7 --miss keep --trace-all",
        "--mode rara --decay linear --miss drop",
        "--mode exact --background 0.1,0.2,0.7 --sh-degree 0 --raster quad --show weight",
        "--mode exact --raster mesh",
        "--mode exact --sort distance",
        "--mode exact --raster tiles",
        "--mode exact --preset fast",
        "--mode exact --preset exact",
        "--mode exact --preset exact --phi logistic --key-bits 20",
        "--mode exact --target-format 8 --sh-format 8",
        "--mode exact --target-format 16f --sh-format 16f --phi cubic",
        "--mode exact --preset fast --sh-format 32f",
        "--mode exact --beam-switch 0.0123 --transmittance-min 0.0000003",
    ] {
        assert_eq!(written(typed), typed);
    }
}

#[test]
fn no_number_is_rounded() {
    let normal = DVec3::new(0.1, -0.7, 1.0 / 3.0);
    let plane = Plane::new(normal, 1e-9 / 7.0).unwrap();
    let settings = Settings::default()
        .background(Some([1.0 / 3.0, f32::MIN_POSITIVE, 0.1 + 0.2]))
        .sigma(1e-7 / 3.0)
        .precision(Precision::default().beam_switch(1e20 / 7.0));
    let typed = vec![Expression::Shape(plane.into())];
    let plane_clip = typed[0].clip();
    let clips = Clips::new(
        ClipEditor::new(typed, ClipOp::And, DVec3::ZERO),
        &[],
        DVec3::ZERO,
    );
    let (read, again) = meant(&flags(&shown(camera(), &clips, &settings)));
    assert_eq!(again, settings);
    assert_eq!(read.frame.clip(), plane_clip);
}

/// Numbers from a generator whose bits look random (Marsaglia 2003: xorshift).
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, most: u64) -> u64 {
        for (left, by) in [(true, 13), (false, 7), (true, 17)] {
            let moved = if left { self.0 << by } else { self.0 >> by };
            self.0 ^= moved;
        }
        self.0 % most
    }

    /// With all of its digits, from -1 to 1.
    fn any(&mut self) -> f64 {
        self.below(1 << 53) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn shape(&mut self) -> Expression {
        let kinds = [
            "plane",
            "slab",
            "box",
            "sphere",
            "ellipsoid",
            "cylinder",
            "capsule",
            "cone",
        ];
        let kind = self.below(8) as usize;
        let count = [4, 5, [6, 10][self.below(2) as usize], 4, 10, 7, 7, 7][kind];
        let mut numbers: Vec<f64> = (0..count).map(|_| self.any()).collect();
        // What is a size is above zero.
        let sizes = match kinds[kind] {
            "box" | "ellipsoid" => 3..6,
            "plane" => 0..0,
            _ => count - 1..count,
        };
        numbers[sizes]
            .iter_mut()
            .for_each(|size| *size = size.abs() + 1e-3);
        let list: Vec<String> = numbers.iter().map(f64::to_string).collect();
        let sign = ["", "!"][self.below(2) as usize];
        format!("{sign}{}:{}", kinds[kind], list.join(","))
            .parse()
            .unwrap()
    }

    fn tree(&mut self, depth: u32) -> Expression {
        let text = match self.below(if depth == 0 { 1 } else { 4 }) {
            0 => return self.shape(),
            1 => format!("not({})", self.tree(depth - 1)),
            kind => {
                let count = 1 + self.below(3);
                let list: Vec<String> = (0..count)
                    .map(|_| self.tree(depth - 1).to_string())
                    .collect();
                format!("{}({})", ["all", "any"][kind as usize - 2], list.join(", "))
            }
        };
        text.parse().unwrap()
    }
}

#[test]
fn every_clip_parses_back_to_itself_wherever_it_was_moved_to() {
    let camera = camera();
    let mut numbers = Numbers(88_172_645_463_325_252);
    for _ in 0..300 {
        let count = 1 + numbers.below(4);
        let typed = (0..count).map(|_| numbers.tree(3)).collect();
        let op = [ClipOp::And, ClipOp::Or][numbers.below(2) as usize];
        let mut clips = Clips::new(ClipEditor::new(typed, op, DVec3::ZERO), &[], DVec3::ZERO);
        for step in 0..6 {
            let pixels = 40.0 * DVec2::new(numbers.any(), numbers.any());
            let action = match step {
                0 => GripAction::Drag(pixels),
                1 => GripAction::Tilt(pixels),
                2 => GripAction::Scale(1.5 + numbers.any()),
                3 => GripAction::Flip,
                4 => GripAction::Go(numbers.any()),
                _ => GripAction::Next,
            };
            clips.act(action, &camera, 1.0);
            let written = flags(&shown(camera, &clips, &Settings::default()));
            let (read, _) = meant(&written);
            let (frame, again) = (&clips.frame, &read.frame);
            assert_eq!(again.expressions(), frame.expressions(), "{written}");
            assert_eq!(again.clip(), frame.clip(), "{written}");
        }
    }
}
