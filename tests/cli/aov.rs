//! `rara render --aov`: channels beside the colours.

use std::path::Path;

use exr::prelude::{ReadChannels, ReadLayers, read};

use super::{document, done, folder, line, refused, scene};

/// The channels of an OpenEXR file, by name.
fn channels(file: &Path) -> Vec<(String, Vec<f32>)> {
    let reader = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels();
    let image = reader.first_valid_layer().all_attributes().from_file(file);
    let list = image.expect("an OpenEXR file").layer_data.channel_data.list;
    let channel = |c: exr::prelude::AnyChannel<exr::prelude::FlatSamples>| {
        (c.name.to_string(), c.sample_data.values_as_f32().collect())
    };
    list.into_iter().map(channel).collect()
}

#[test]
fn channels_say_what_the_picture_is_made_of() {
    let here = folder("aov");
    scene(&here);
    let view = "--size 64x48 --eye 3,-2,-5 --target 0,0,0 --clip plane:1,0,0,0";
    done(line(
        &here,
        &format!("render @/scene.ply -o @/plain.exr {view}"),
    ));
    let words =
        format!("render @/scene.ply -o @/a.exr --aov weight,depth,normal,layer,count,depth {view}");
    done(line(&here, &words));
    // The colours are those without the flag.
    let difference = document(line(&here, "compare @/plain.exr @/a.exr --json"));
    assert_eq!(difference["max"], 0.0);

    let channels = channels(&here.join("a.exr"));
    let names: Vec<&str> = channels.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(
        names,
        [
            "A", "B", "G", "N.X", "N.Y", "N.Z", "R", "Z", "count", "layer", "weight"
        ]
    );
    let of = |name: &str| &channels.iter().find(|c| c.0 == name).expect("a channel").1;
    let (alpha, depth, weight) = (of("A"), of("Z"), of("weight"));
    // From the eye to the middle it is as far as this.
    let far = 38.0_f32.sqrt();
    let mut shown = 0;
    for at in 0..64 * 48 {
        let normal = glam::Vec3::new(of("N.X")[at], of("N.Y")[at], of("N.Z")[at]);
        if alpha[at] < 0.1 {
            assert!(alpha[at] > 0.0 || (depth[at], weight[at], normal.length()) == (0.0, 0.0, 0.0));
            continue;
        }
        shown += 1;
        assert_eq!(of("layer")[at], 0.0);
        assert!(of("count")[at] >= 1.0);
        assert!((0.2 * far..2.0 * far).contains(&depth[at]), "{}", depth[at]);
        assert!((0.0..=1.0).contains(&weight[at]), "{}", weight[at]);
        assert!((normal.length() - 1.0).abs() < 1e-4, "{normal}");
    }
    assert!(shown > 100, "{shown} pixels show something");
    let cut = weight.iter().filter(|w| (0.05..0.95).contains(*w)).count();
    assert!(cut > 10, "{cut} pixels show the cut");
    // The mean normal looks at the eye.
    let sum = |name: &str| of(name).iter().sum::<f32>();
    assert!(3.0 * sum("N.X") - 2.0 * sum("N.Y") - 5.0 * sum("N.Z") > 0.0);
}

/// The same numbers stand beside a .npy, and 16 bits of them beside a .png.
#[test]
fn channels_beside_png_and_npy() {
    let here = folder("aov-beside");
    scene(&here);
    let view = "--size 64x48 --eye 3,-2,-5 --target 0,0,0 --aov depth,normal,layer,weight,count";
    for ending in ["exr", "npy", "png"] {
        done(line(
            &here,
            &format!("render @/scene.ply -o @/a.{ending} {view}"),
        ));
    }
    let all = channels(&here.join("a.exr"));
    let of = |name: &str| &all.iter().find(|c| c.0 == name).expect("a channel").1;
    let array = |name: &str| {
        let bytes = std::fs::read(here.join(name)).expect("an array");
        assert!(bytes.starts_with(b"\x93NUMPY"));
        let numbers = bytes[128..].chunks_exact(4);
        let numbers = numbers.map(|four| f32::from_le_bytes(four.try_into().expect("four")));
        numbers.collect::<Vec<_>>()
    };
    assert_eq!(array("a.depth.npy"), *of("Z"));
    let normals = array("a.normal.npy");
    let colours = array("a.npy");
    for at in 0..64 * 48 {
        let normal = ["N.X", "N.Y", "N.Z"].map(|name| of(name)[at]);
        assert_eq!(normals[3 * at..][..3], normal);
        let colour = ["R", "G", "B", "A"].map(|name| of(name)[at]);
        assert_eq!(colours[4 * at..][..4], colour);
    }
    for (file, name, steps, plus) in [
        ("a.depth.png", "Z", 1000.0, 0.0),
        ("a.weight.png", "weight", 65535.0, 0.0),
        ("a.count.png", "count", 1.0, 0.0),
        ("a.layer.png", "layer", 1.0, 1.0),
    ] {
        let decoder = png::Decoder::new(std::io::BufReader::new(
            std::fs::File::open(here.join(file)).expect("a picture"),
        ));
        let mut reader = decoder.read_info().expect("a PNG");
        let info = reader.info();
        assert_eq!((info.width, info.height), (64, 48));
        assert_eq!(
            (info.bit_depth, info.color_type),
            (png::BitDepth::Sixteen, png::ColorType::Grayscale)
        );
        let mut bytes = vec![0; 2 * 64 * 48];
        reader.next_frame(&mut bytes).expect("pixels");
        for (two, value) in bytes.chunks_exact(2).zip(of(name)) {
            let stored = f32::from(u16::from_be_bytes([two[0], two[1]]));
            assert!(
                (stored - (value * steps + plus)).abs() <= 0.51,
                "{file}: {stored} {value}"
            );
        }
    }
    for name in ["a.mp4", "a.apng"] {
        let output = line(&here, &format!("render @/scene.ply -o @/{name} {view}"));
        refused(&output, 2, "--aov makes channels");
    }
}

#[test]
fn channels_are_the_same_whatever_the_picture_shows_and_holds() {
    let here = folder("aov-other");
    scene(&here);
    let of = |flags: &str| {
        let words = format!(
            "render @/scene.ply -o @/a.exr --aov weight,depth,normal,layer,count --size 64x48 --eye 3,-2,-5 --target 0,0,0 \
             --clip plane:1,0,0,0 {flags}"
        );
        done(line(&here, &words));
        let mut channels = channels(&here.join("a.exr"));
        channels.retain(|(name, _)| !["R", "G", "B", "A"].contains(&name.as_str()));
        channels
    };
    let truth = of("");
    let count = truth
        .iter()
        .find(|(name, _)| name == "count")
        .expect("it is asked for");
    assert!(
        count.1.iter().any(|count| *count > 1.0),
        "pixels of several splats"
    );
    for flags in [
        "--target-format 8",
        "--target-format 16f",
        "--show count",
        "--show mean",
    ] {
        for ((name, expected), (_, found)) in truth.iter().zip(of(flags)) {
            assert!(*expected == found, "{flags}: {name} is as without it");
        }
    }
}

#[test]
fn channels_need_an_exr_file() {
    let here = folder("aov-refused");
    for (words, what) in [
        ("render x.ply -o a.mp4 --aov depth", ".exr"),
        ("render x.ply --json --aov depth", "--output"),
        (
            "render x.ply -o a.exr --aov beauty",
            "depth, normal, layer, weight, count",
        ),
    ] {
        refused(&line(&here, words), 2, what);
    }
}
