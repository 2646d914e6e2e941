use super::*;

#[test]
fn a_json_file_is_what_it_says() {
    for (text, is) in [
        (r#"[{"normal":[1,0,0],"d":0}]"#, JsonKind::Clips),
        (
            r#"[{"name":"a","clip":{"sphere":{"centre":[0,0,0],"radius":1}}}]"#,
            JsonKind::Clips,
        ),
        ("[]", JsonKind::Clips),
        (
            r#"[{"id":0,"img_name":"a","width":8,"height":8,"position":[0,0,0]}]"#,
            JsonKind::Cameras,
        ),
        (r#"{"frames":[]}"#, JsonKind::Cameras),
        (r#"{"width":8,"world_to_camera":[]}"#, JsonKind::Cameras),
        (
            r#"[{"name":"a","world_to_camera":[],"fx":1}]"#,
            JsonKind::Cameras,
        ),
        (r#"{"layers":[]}"#, JsonKind::Scene),
        ("{}", JsonKind::Scene),
        ("7", JsonKind::Scene),
    ] {
        let document = serde_json::from_str(text).expect("JSON");
        assert_eq!(JsonKind::from_document(&document), is, "{text}");
    }
}
