//! A participant answers the whole user study by the keyboard, on a page as wide as a phone's.

use std::path::{Path, PathBuf};

use rara::{HeadlessDesc, Mode};
use rara_lab::study::{self, Metric, StudyOptions, StudyPage};
use serde_json::json;

use crate::browser::{Browser, ENTER, HOME, LEFT, RIGHT, TAB, UP};
use crate::folder::{Folder, until};

/// A study of twenty cases whose pictures are tiny.
fn tiny(folder: &Path) -> StudyPage {
    let options = StudyOptions {
        method: Mode::Rara,
        gaussians: 200,
        size: 24,
        frames: 3,
        frame_size: 16,
        ..StudyOptions::default()
    };
    let mut calls = Vec::new();
    let mut progress = |done, of| calls.push((done, of));
    let written = study::create(
        folder,
        &[],
        &HeadlessDesc::default(),
        &options,
        &mut progress,
    );
    assert_eq!(calls, (0..=20).map(|done| (done, 20)).collect::<Vec<_>>());
    written.expect("a study")
}

/// What the participant prefers about an item, -7 to 7 without 0.
fn preference(case: usize, metric: Metric) -> i8 {
    let strength = 1 + (case + metric as usize) % 7;
    if case % 5 == 4 {
        -(strength as i8)
    } else {
        strength as i8
    }
}

/// What must hold on every screen: nothing is cut off at the side, what has the focus shows it, and everything has a name.
fn check_screen(browser: &Browser) {
    let wrong = browser.text(
        "const wide = document.documentElement.scrollWidth - innerWidth;
         if (wide > 0) return `wider by ${wide}`;
         const focus = document.activeElement;
         const marks = [focus, focus.nextElementSibling].filter(Boolean).map((e) => getComputedStyle(e).outlineStyle);
         if (focus.tagName !== 'H1' && marks.every((style) => style === 'none')) return `no visible focus: ${focus.tagName}`;
         for (const field of document.querySelectorAll('input, select, textarea')) {
           if (!field.labels.length || !field.labels[0].textContent.trim()) return `no label: ${field.id}`;
         }
         for (const image of document.querySelectorAll('img, canvas')) {
           if (!(image.alt || image.ariaLabel)) return `no name: ${image.id}`;
         }
         return '';",
    );
    assert_eq!(wrong, "", "on {}", heading(browser));
}

fn heading(browser: &Browser) -> String {
    browser.text("return document.querySelector('h1').textContent")
}

/// Presses keys until the focus is on what matches.
fn tab_to(browser: &Browser, selector: &str) {
    for _ in 0..20 {
        browser.press(TAB);
        let script = format!(
            "return String(document.activeElement.matches({}))",
            json!(selector)
        );
        if browser.text(&script) == "true" {
            return check_screen(browser);
        }
    }
    panic!(
        "{selector} cannot be reached by the keyboard on {:?}",
        heading(browser)
    );
}

/// The moving cut can be placed by the keyboard, and both sides show that place.
fn check_sweep(browser: &Browser) {
    tab_to(browser, "#place");
    for (key, place) in [(HOME, 0), (RIGHT, 1), (RIGHT, 2)] {
        browser.press(key);
        let shown = format!(
            "const {{ columns, size }} = STUDY.sweep;
             const [x, y] = [({place} % columns) * size, Math.floor({place} / columns) * size];
             const {{ shown, left }} = current();
             const sides = left === 'hard' ? [shown.hard, shown.method] : [shown.method, shown.hard];
             const canvases = ['left-sweep', 'right-sweep'].map(find);
             return String(canvases.every((canvas, side) => {{
               window.kept = window.kept || {{}};
               const source = sides[side].sweep;
               const image = window.kept[source] ||= Object.assign(new Image(), {{ src: source }});
               if (!image.complete) return false;
               const other = Object.assign(document.createElement('canvas'), {{ width: size, height: size }});
               other.getContext('2d').drawImage(image, x, y, size, size, 0, 0, size, size);
               const pixels = (of) => String(of.getContext('2d').getImageData(0, 0, size, size).data);
               return pixels(canvas) === pixels(other) && find('place').value === '{place}';
             }}));"
        );
        until(&format!("place {place}"), || {
            (browser.text(&shown) == "true").then_some(())
        });
    }
    assert_eq!(browser.text("return find('play').textContent"), "Play");
}

/// The file that the page has saved.
fn saved(folder: &Path, name: &str) -> PathBuf {
    let file = folder.join(name);
    until(name, || file.exists().then_some(()));
    file
}

/// Answers one item and returns its case and metric.
fn answer(browser: &Browser, cases: &[String]) -> (usize, Metric) {
    let item = browser
        .run("const { shown, metric, left } = current(); return [shown.name, metric.key, left]");
    let case = cases
        .iter()
        .position(|name| *name == item[0])
        .expect("a case of the study");
    let metric: Metric = serde_json::from_value(item[1].clone()).expect("a metric");
    let preference = preference(case, metric);
    let is_left = (preference > 0) == (item[2] == "method");
    let side = if is_left { LEFT } else { RIGHT };
    browser.press(&format!("{side}{}{ENTER}", preference.unsigned_abs()));
    (case, metric)
}

#[test]
fn a_participant_answers_by_keyboard_on_a_phone_and_the_report_has_every_answer() {
    let folder = Folder::new("study");
    let Some(browser) = Browser::start(&folder) else {
        eprintln!("SKIPPED: chromedriver is not installed, so nobody answers the user study here");
        return;
    };
    let written = tiny(&folder.join("page"));
    let count = written.cases.len();
    assert_eq!(count, 20);
    browser.resize(360, 740);
    browser.open(&format!("file://{}?group=1", written.page.display()));

    // Consent, which must be given.
    check_screen(&browser);
    browser.press(ENTER);
    assert_eq!(heading(&browser), "Comparing cuts through 3D scenes");
    tab_to(&browser, "#agree");
    browser.press(&format!(" {ENTER}"));
    assert_eq!(heading(&browser), "About you");
    check_screen(&browser);
    tab_to(&browser, "#participant");
    browser.press(" p7");
    tab_to(&browser, "#age");
    browser.press("2");
    tab_to(&browser, "#experience");
    browser.press("E");
    tab_to(&browser, "button:not(.back)");
    browser.press(ENTER);

    // The first item: nothing is confirmed that is not complete, and a side comes before its strength.
    let first = heading(&browser);
    assert!(first.starts_with("Case 1 of 20: "), "{first}");
    check_screen(&browser);
    browser.press(&format!("5{ENTER}"));
    assert_eq!(
        browser.text("return String(document.querySelectorAll(':checked').length)"),
        "0"
    );
    assert_eq!(heading(&browser), first);
    // What was chosen survives a reload, and up and down change the strength.
    browser.press(&format!("{LEFT}3{UP}"));
    browser.reload();
    assert_eq!(heading(&browser), first);
    let checked =
        "return [...document.querySelectorAll('input:checked')].map((e) => e.value).join()";
    assert_eq!(browser.text(checked), "left,4");
    check_screen(&browser);
    let player =
        "return document.getElementById('play').textContent + document.getElementById('place').max";
    assert_eq!(browser.text(player), "Pause2");
    check_sweep(&browser);
    assert_eq!(
        browser.text(checked),
        "left,4",
        "the slider's keys are its own"
    );
    tab_to(&browser, "input[name=choice]");

    // All of them; back leads to the item before, whose answer is there.
    for number in 0..3 * count {
        if number == 4 {
            tab_to(&browser, ".back");
            browser.press(ENTER);
            assert_ne!(browser.text(checked), "");
            browser.press(ENTER);
        }
        let (case, metric) = answer(&browser, &written.cases);
        assert!((metric as usize) < 3, "{case} {metric:?} is not of group 1");
    }

    assert_eq!(heading(&browser), "In your own words");
    check_screen(&browser);
    tab_to(&browser, "#properties");
    browser.press(&format!("Flat{ENTER}and calm"));
    tab_to(&browser, "button:not(.back)");
    browser.press(ENTER);
    assert_eq!(heading(&browser), "Save your answers");
    check_screen(&browser);
    browser.press(ENTER);
    let file = saved(&folder, "rara-study-P7.json");

    let options = study::report::ReportOptions {
        study: Some(written.study.clone()),
    };
    let report = folder.join("report");
    let evaluation = study::report::create(&[file], &report, &options).expect("a report");
    assert!(report.join("report.html").is_file());
    let participant = &evaluation.participants[0];
    assert!(participant.is_complete());
    assert_eq!((participant.code.as_str(), participant.group), ("P7", 1));
    assert_eq!(participant.background.age, "25-34");
    assert_eq!(participant.background.experience, "expert");
    assert_eq!(participant.questions.properties, "Flat\nand calm");
    assert_eq!(evaluation.study.method, "rara");
    for (case, row) in evaluation.by_case.iter().enumerate() {
        for (metric, mean) in Metric::ALL.into_iter().zip(row) {
            let expected = ((metric as usize) < 3).then(|| f64::from(preference(case, metric)));
            assert_eq!(
                *mean, expected,
                "{:?} {metric:?}",
                evaluation.study.cases[case]
            );
        }
    }
    let positions: Vec<_> = participant.answers.iter().map(|a| a.position).collect();
    assert_eq!(positions, (1..=60).collect::<Vec<_>>());
    assert!(
        participant
            .answers
            .iter()
            .all(|a| a.changes >= 2 && a.ms > 0)
    );
}

#[test]
fn the_plan_depends_on_the_code_alone_and_is_balanced() {
    let folder = Folder::new("study-plan");
    let Some(browser) = Browser::start(&folder) else {
        eprintln!(
            "SKIPPED: chromedriver is not installed, so no plan of the user study is made here"
        );
        return;
    };
    let written = tiny(&folder.join("page"));
    browser.resize(1280, 800);
    browser.open(&format!("file://{}", written.page.display()));
    check_screen(&browser);
    let found = browser.run(
        "const codes = Array.from({ length: 40 }, (_, i) => `P${i + 1}`);
         const plans = codes.map((code) => plan(STUDY, code, groupOf(code, '')));
         const lefts = (items) => items.filter(({ left, part }) => left === 'method' && part === 1).length;
         const orders = new Set(plans.map((items) => items.map(({ key }) => key).join()));
         return {
           groups: codes.filter((code) => groupOf(code, '') === 1).length,
           same: JSON.stringify(plan(STUDY, 'P3', 2)) === JSON.stringify(plan(STUDY, 'P3', 2)),
           items: plans.every((items) => new Set(items.map(({ key }) => key)).size === 60),
           balanced: plans.every((items) => lefts(items) === 10),
           orders: orders.size,
           asked: groupOf('P1', '?group=1') === 1 && groupOf('P1', '?group=2') === 2,
         };",
    );
    // Numbers of one digit take turns, and so do those of two within ten.
    let expected = json!({ "groups": 20, "same": true, "items": true, "balanced": true, "orders": 40, "asked": true });
    assert_eq!(found, expected);
}

#[test]
fn scenes_of_files_keep_their_names_and_the_same_study_has_the_same_number() {
    let folder = Folder::new("study-files");
    let scenes = ["one/hair.ply", "two/hair.ply"].map(|name| {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("it is made");
        let gaussians = rara::scene::generate(rara::scene::Kind::Strands, 100, 1);
        rara::scene::save_ply(&path, &gaussians).expect("a file");
        path
    });
    let options = StudyOptions {
        cases: 4,
        size: 16,
        frames: 2,
        frame_size: 8,
        ..StudyOptions::default()
    };
    let device = HeadlessDesc::default();
    let create = |name: &str, options: &StudyOptions| {
        study::create(
            &folder.join(name),
            &scenes,
            &device,
            options,
            &mut |_, _| {},
        )
    };
    let written = create("a", &options).expect("a study");
    let cases = [
        "hair, face",
        "hair, edge",
        "hair, face (2)",
        "hair, edge (2)",
    ];
    assert_eq!(written.cases, cases);
    // Again into the same folder, and into another one.
    for name in ["a", "b"] {
        assert_eq!(
            create(name, &options).expect("a study").study,
            written.study
        );
    }
    let larger = StudyOptions {
        size: 17,
        ..options.clone()
    };
    assert_ne!(create("c", &larger).expect("a study").study, written.study);
    // A scene of nothing cannot be cut, and no folder is left.
    let empty = folder.join("empty.ply");
    rara::scene::save_ply(&empty, &rara::Gaussians::default()).expect("a file");
    let page = folder.join("d");
    let refused = study::create(&page, &[empty], &device, &options, &mut |_, _| {});
    assert!(refused.is_err() && !page.exists(), "{refused:?}");
}
