use super::*;
use crate::study::answers::tests::answers;
use crate::study::evaluation::tests::Files;

#[test]
fn the_report_says_what_the_evaluation_found_and_runs_nothing_that_was_written() {
    let metrics = [
        Metric::Flatness,
        Metric::TemporalStability,
        Metric::TopologicalIntegrity,
    ];
    let mut all = Vec::new();
    for (number, code) in ["P1", "P2", "<script>x</script>"].into_iter().enumerate() {
        let given: Vec<_> = metrics
            .iter()
            .flat_map(|&metric| [("a, face", metric, 5), ("b|c", metric, number as i8 + 1)])
            .collect();
        all.push(answers(code, &["a, face", "b|c"], &given));
    }
    all[1].questions.strengths = "<img src=x> *bold*\nand | more".into();
    all[1].answers.pop();
    let (folder, files) = Files::of("report", &all.iter().collect::<Vec<_>>());
    let out = folder.0.join("report");
    create(&files, &out, &ReportOptions::default()).expect("a report");
    let read = |name: &str| fs::read_to_string(out.join(name)).expect(name);
    let (html, markdown) = (read("report.html"), read("report.md"));
    for text in [&html, &markdown] {
        assert!(
            text.contains("3 participants gave 17 answers of 18; 1 of them answered only a part")
        );
        assert!(text.contains("Flatness") && text.contains("3.50"), "{text}");
    }
    assert!(
        !html.to_lowercase().contains("<script>") && !html.contains("<img"),
        "{html}"
    );
    assert!(html.matches("<svg").count() == 3);
    assert!(
        markdown.contains("\\<img src=x\\> \\*bold\\* and \\| more"),
        "{markdown}"
    );
    for chart in ["heat_map.svg", "violins.svg", "radar.svg"] {
        roxmltree::Document::parse(&read(chart)).expect(chart);
        assert!(markdown.contains(&format!("({chart})")));
    }
    let csv = read("answers.csv");
    assert_eq!(csv.lines().count(), 18);
    assert!(
        csv.contains(r#""P1",1,"a, face","Flatness","hard","right",5,5,1000,2,1,"#),
        "{csv}"
    );
    assert_eq!(read("metrics.csv").lines().count(), 13);
}
