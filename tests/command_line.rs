//! The command-line program from a user's point of view.

use std::fs;
use std::path::Path;
use std::process::Stdio;

use assert_cmd::Command;
use assert_cmd::assert::Assert;

fn kfrac(folder: &Path) -> Command {
    let mut command = Command::cargo_bin("kfrac").unwrap();
    command
        .current_dir(folder)
        .env_remove("KFRAC_LIBRARY")
        .env("XDG_DATA_HOME", folder.join("data"));
    command
}

fn stdout(assert: &Assert) -> String {
    String::from_utf8(assert.get_output().stdout.clone()).unwrap()
}

fn stderr(assert: &Assert) -> String {
    String::from_utf8(assert.get_output().stderr.clone()).unwrap()
}

fn run(folder: &Path, arguments: &[&str]) -> Assert {
    kfrac(folder).args(arguments).assert()
}

fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn the_main_job_works_in_an_empty_folder() {
    let folder = tempfile::tempdir().unwrap();
    let run = run(folder.path(), &["grow", "pythagoras.yaml", "--steps", "8"]).success();
    let said = stderr(&run);
    assert!(
        said.starts_with("pythagoras.svg: step 8 of pythagoras, 766 elements, 1024 x 725 pixels, "),
        "{said}"
    );
    assert_eq!(said.lines().count(), 1);
    assert_eq!(stdout(&run), "");
    let svg = fs::read_to_string(folder.path().join("pythagoras.svg")).unwrap();
    assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
    assert_eq!(files(folder.path()), ["pythagoras.svg"]);
}

#[test]
fn rows_are_elements_in_order_of_traversal() {
    let folder = tempfile::tempdir().unwrap();
    let csv = run(
        folder.path(),
        &[
            "grow", "koch", "--steps", "1", "--format", "csv", "-o", "-", "-q",
        ],
    )
    .success();
    assert_eq!(
        stdout(&csv),
        "fractal,age,index,x0,y0,x1,y1,fertile,direction,visible\n\
         0,1,1,0,0,0.3333333333333333,0,true,1,true\n\
         0,1,2,0.3333333333333333,0,0.5,0.28867513459481287,true,1,true\n\
         0,1,3,0.5,0.28867513459481287,0.6666666666666666,0,true,1,true\n\
         0,1,4,0.6666666666666666,0,1,0,true,1,true\n"
    );
    let json = run(
        folder.path(),
        &[
            "grow", "spiral", "--steps", "0", "--format", "json", "-o", "-",
        ],
    )
    .success();
    assert_eq!(
        stdout(&json),
        "{\"fractal\":0,\"age\":0,\"index\":1,\"x0\":0,\"y0\":0,\"x1\":1,\"y1\":0,\"fertile\":true,\
         \"direction\":1,\"visible\":true}\n"
    );
    assert_eq!(files(folder.path()), [""; 0]);
}

#[test]
fn count_tells_what_a_walk_finds() {
    let folder = tempfile::tempdir().unwrap();
    let text = run(folder.path(), &["count", "koch", "--steps", "6"]).success();
    assert_eq!(
        stdout(&text),
        "elements  4,096\nfertile   4,096\nfractals  1\nlength    5.61865569273\n\
         bounds    [0, 0] to [1, 0.288675134595]\n"
    );
    let json = ["count", "koch", "--steps", "3", "--json", "--threads", "2"];
    let json = run(folder.path(), &json).success();
    let json: serde_json::Value = serde_json::from_str(&stdout(&json)).unwrap();
    let keys = [
        "bounds", "elements", "fertile", "fractals", "length", "name", "steps",
    ];
    assert!(json.as_object().unwrap().keys().eq(keys));
    assert_eq!(json["elements"], "64");
    assert_eq!(json["bounds"]["max"][0], 1);
    let many = ["count", "koch", "--steps", "13"];
    let refused = run(folder.path(), &many).failure();
    assert!(stderr(&refused).contains("--max-elements"));
    assert_eq!(files(folder.path()), [""; 0]);
}

#[test]
fn info_tells_the_size_of_every_step() {
    let folder = tempfile::tempdir().unwrap();
    let info = run(folder.path(), &["info", "koch", "--steps", "3", "--json"]).success();
    let info: serde_json::Value = serde_json::from_str(&stdout(&info)).unwrap();
    let keys: Vec<_> = info
        .as_object()
        .unwrap()
        .keys()
        .map(String::as_str)
        .collect();
    let mut expected = [
        "name",
        "kind",
        "space",
        "title",
        "params",
        "random",
        "regular",
        "steps",
        "elements",
        "fertile",
        "fractals",
        "length",
        "area",
        "svg_bytes",
        "seconds",
        "instanced_svg_bytes",
        "bounds",
        "limit_bounds",
        "dimension",
    ];
    expected.sort_unstable();
    assert_eq!(keys, expected);
    assert_eq!(info["elements"], serde_json::json!(["1", "4", "16", "64"]));
    assert_eq!(info["fractals"], serde_json::json!(["1", "1", "1", "1"]));
    assert_eq!(info["area"], serde_json::Value::Null);
    let estimates = ["svg_bytes", "seconds"].map(|key| info[key].as_array().unwrap());
    for estimate in estimates {
        assert_eq!(estimate.len(), 4);
        assert!(estimate.is_sorted_by_key(|value| value.as_f64().unwrap()));
    }
    assert_eq!(info["instanced_svg_bytes"], 2300);
    assert_eq!(info["bounds"]["min"], serde_json::json!([0, 0]));
    let dimension = info["dimension"]["similarity"].as_f64().unwrap();
    assert!((dimension - 4f64.ln() / 3f64.ln()).abs() < 1e-12);

    let info = run(folder.path(), &["info", "random-tree", "--json"]).success();
    let info: serde_json::Value = serde_json::from_str(&stdout(&info)).unwrap();
    assert_eq!(info["random"], true);
    assert!(info["elements"].is_array() && info["length"].is_null() && info["bounds"].is_null());
}

/// The draw between two generators with equal numbers of elements does not affect counts.
#[test]
fn counts_are_told_where_they_do_not_hang_on_the_draw() {
    let folder = tempfile::tempdir().unwrap();
    let text = "initiator: segment\ngenerators:\n  up: koch\n  down: [[0, 0], [1/3, 0], [1/2, -sqrt(3)/6], \
                [2/3, 0], [1, 0]]\nselect: {at_random: {up: 1, down: 1}}\n";
    fs::write(folder.path().join("coast.yaml"), text).unwrap();
    let elements = || {
        let info = run(
            folder.path(),
            &["info", "coast.yaml", "--steps", "2", "--json"],
        )
        .success();
        let info: serde_json::Value = serde_json::from_str(&stdout(&info)).unwrap();
        info["elements"].clone()
    };
    assert_eq!(elements(), serde_json::json!(["1", "4", "16"]));
    fs::write(
        folder.path().join("coast.yaml"),
        text.replace(", [2/3, 0]", ""),
    )
    .unwrap();
    assert!(elements().is_null());
}

#[test]
fn a_step_that_is_too_large_is_refused_before_the_work_starts() {
    let folder = tempfile::tempdir().unwrap();
    let refused = run(folder.path(), &["grow", "koch", "--steps", "40"]).code(1);
    assert_eq!(
        stderr(&refused),
        "error: step 40 of koch has 1,208,925,819,614,629,174,706,176 elements, about 48 GB of SVG and \
         4e8 years of drawing; 12 is the deepest step within --max-elements 50,000,000; \
         --detail 0.5 draws it to half a pixel\n"
    );
    // Estimates apply to the requested picture, and tables are not drawn.
    let refused = |arguments: &[&str]| {
        let arguments = [&["grow"], arguments].concat();
        stderr(&run(folder.path(), &arguments).code(1))
    };
    let small = refused(&["carpet", "--steps", "12", "--size", "100"]);
    let large = refused(&["carpet", "--steps", "12", "--size", "100000"]);
    assert!(
        small.contains("about 860 GB of SVG and 69 min of drawing"),
        "{small}"
    );
    assert!(large.contains("about 2.3 TB of SVG"), "{large}");
    let table = refused(&["koch", "--steps", "13", "--format", "csv"]);
    assert!(
        table.ends_with(
            "67,108,864 elements; 12 is the deepest step within --max-elements 50,000,000\n"
        ),
        "{table}"
    );
    // Draws decide the lengths of elements, and whether they shrink.
    let drawn = refused(&["vegetation", "--steps", "60"]);
    assert!(
        !drawn.contains(" of SVG") && !drawn.contains("--detail"),
        "{drawn}"
    );
    // Where the size is unknown beforehand, the walk ends at the limit and leaves no file.
    fs::write(
        folder.path().join("many.yaml"),
        "initiator: segment\ngenerators: {a: koch, b: levy}\nselect: {at_random: {a: 1, b: 1}}\n",
    )
    .unwrap();
    let ended = run(
        folder.path(),
        &[
            "grow",
            "many.yaml",
            "--steps",
            "30",
            "--max-elements",
            "1000",
        ],
    )
    .code(1);
    assert!(
        stderr(&ended).contains("more than 1,000 elements"),
        "{}",
        stderr(&ended)
    );
    assert_eq!(files(folder.path()), ["many.yaml"]);
}

#[test]
fn an_svg_is_light_unless_more_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let koch = "initiator: segment\ngenerator: koch\nsteps: 9\n";
    fs::write(folder.path().join("koch9.yaml"), koch).unwrap();
    let uneven =
        "initiator: segment\ngenerator: [[0, 0], [0.3, 0.3], [0.5, 0], [1, 0]]\nsteps: 14\n";
    fs::write(folder.path().join("uneven.yaml"), uneven).unwrap();
    for (arguments, note) in [
        (&["grow", "koch9.yaml"][..], "step 7 is drawn instead of 9"),
        (&["grow", "uneven.yaml"], "pixels are not replaced"),
        (
            &["sheet", "koch9.yaml"],
            "steps 0..7 are drawn instead of 0..9",
        ),
    ] {
        let name = arguments[1];
        let said =
            stderr(&run(folder.path(), &[arguments, &["-o", "light.svg"]].concat()).success());
        assert!(
            said.starts_with("note: ") && said.contains(note),
            "{name}: {said}"
        );
        assert!(said.contains("; --"), "{name}: how to get more: {said}");
        let light = fs::read(folder.path().join("light.svg")).unwrap();
        assert!(
            (20_000..=2_000_000).contains(&light.len()),
            "{name}: {}",
            light.len()
        );
        let quiet = [arguments, &["-q", "-o", "quiet.svg"]].concat();
        assert_eq!(stderr(&run(folder.path(), &quiet).success()), "");
        assert!(
            fs::read(folder.path().join("quiet.svg")).unwrap() == light,
            "{name}"
        );
    }
    let all = run(folder.path(), &["grow", "koch9.yaml", "--steps", "9"]).success();
    assert!(stderr(&all).contains("262,144 elements"));
    assert!(!stderr(&all).contains("note:"));
    let all = run(
        folder.path(),
        &["grow", "koch9.yaml", "--max-elements", "300000"],
    )
    .success();
    assert!(stderr(&all).contains("262,144 elements"));
}

#[test]
fn strokes_of_what_is_filled_are_drawn_or_missed() {
    let folder = tempfile::tempdir().unwrap();
    let file = "initiator: segment\nbase_element: triangle\ngenerator: [[0, 0], [1/2, 1/4], [1, 0]]\nsteps: 2\n";
    fs::write(folder.path().join("mine.yaml"), file).unwrap();
    let outlined = [
        "grow",
        "mine.yaml",
        "--color-by",
        "index",
        "--stroke",
        "#123456",
        "-o",
        "-",
    ];
    let svg = stdout(&run(folder.path(), &outlined).success());
    assert!(svg.contains("<g stroke=\"#123456\">") && !svg.contains("stroke=\"none\""));
    let wide = run(folder.path(), &["grow", "mine.yaml", "--stroke-width", "4"]).success();
    assert!(stderr(&wide).starts_with("note: mine is drawn as filled shapes"));
    let wide = run(folder.path(), &["grow", "koch", "--stroke-width", "4"]).success();
    assert!(!stderr(&wide).contains("note:"));
}

#[test]
fn parameters_are_set_by_name_and_within_their_limits() {
    let folder = tempfile::tempdir().unwrap();
    let rows = |setting: &str| {
        let arguments = [
            "grow",
            "pythagoras",
            "--steps",
            "1",
            "--set",
            setting,
            "-o",
            "-",
            "--format",
            "csv",
        ];
        run(folder.path(), &arguments)
    };
    assert!(
        stdout(&rows("angle=30").success()).contains(",0.7499999999999999,1.4330127018922192,")
    );
    assert_eq!(
        stdout(&rows("angle=60/2").success()),
        stdout(&rows("angle=30").success())
    );
    let unknown = rows("angel=30").code(2);
    assert!(
        stderr(&unknown).contains("did you mean 'angle'?"),
        "{}",
        stderr(&unknown)
    );
    assert!(stderr(&rows("angle=89").code(2)).contains("above its largest value 85"));
    rows("angle").code(2);
    rows("angle=1/0").code(2);
}

#[test]
fn the_command_line_has_its_own_exit_status() {
    let folder = tempfile::tempdir().unwrap();
    for wrong in [
        &["grow"][..],
        &["grow", "koch", "--steps", "-1"],
        &["grow", "koch", "--size", "0x0"],
        &["grow", "koch", "--threads", "0"],
        &["sheet", "koch", "--threads", "-1"],
        &["grow", "koch", "--stroke", "blurple"],
        &["grow", "koch", "--palette", "virids"],
        &["grow", "koch", "-o", "koch.bmp"],
        &["grow", "koch", "--view", "0,0,0,1"],
        &["grwo", "koch"],
    ] {
        run(folder.path(), wrong).code(2);
    }
    run(folder.path(), &["grow", "kosh"]).code(1);
    run(folder.path(), &["grow", "koch", "--margin", "600"]).code(1);
    run(
        folder.path(),
        &["grow", "koch", "-o", "no/such/folder/koch.svg"],
    )
    .code(1);
    assert_eq!(files(folder.path()), [""; 0]);
}

#[test]
fn mistakes_on_the_command_line_are_told_in_its_own_words() {
    let folder = tempfile::tempdir().unwrap();
    for (wrong, message) in [
        (
            &["grow", "koch", "--seed", "abc"][..],
            "a seed is a whole number from 0 to ",
        ),
        (
            &["grow", "koch", "--seed", "-1"],
            "a seed is a whole number from 0 to ",
        ),
        (
            &["dim", "koch", "--seed", "1.5"],
            "a seed is a whole number from 0 to ",
        ),
        (
            &["grow", "koch", "--max-elements", "many"],
            "a number of elements is a whole number from 0 to ",
        ),
        (
            &["dim", "koch", "--threads", "0"],
            "a number of threads is a whole number from 1 to 1024",
        ),
        (
            &["sheet", "koch", "--samples", "x"],
            "a number of values is a whole number from 2 to 1000",
        ),
        (
            &["grow", "koch", "--size", "10ft"],
            "a side is a whole number of pixels from 1 to 1000000, with --tiles to 1073741824, or a length of whole tenths of a \
             millimetre up to 100000mm: 200mm, 21cmx29.7cm, 8.5inx11in; papers are a0 to a6",
        ),
        (
            &["grow", "koch", "--stroke", "nonee"],
            "write a colour as CSS does: teal, #3b7ea1, rgb(59, 126, 161); or none",
        ),
    ] {
        let said = stderr(&run(folder.path(), wrong).code(2));
        assert!(said.contains(message), "{wrong:?}: {said}");
    }
    for (missing, message) in [
        (
            &["grow", "missing.yaml"][..],
            "error: there is no file 'missing.yaml', and no rule of this name in the library\n",
        ),
        (
            &["dim", "kohc.png"],
            "error: there is no file 'kohc.png', and no rule of this name in the library\n",
        ),
        (
            &["check", "./koch.yaml"],
            "error: there is no file './koch.yaml'\n",
        ),
        (&["import", "no.l"], "error: there is no file 'no.l'\n"),
        (
            &["list", "kohc"],
            "error: nothing in the library has 'kohc' in its name, title or tags\n |\n \
             = help: did you mean 'koch'?\n",
        ),
    ] {
        let said = stderr(&run(folder.path(), missing).code(1));
        assert!(said.starts_with(message), "{missing:?}: {said}");
    }
    assert_eq!(
        stdout(&run(folder.path(), &["list", "kohc", "--json"]).success()),
        "[]\n"
    );
    assert_eq!(files(folder.path()), [""; 0]);
}

#[test]
fn colours_may_be_none_as_in_files() {
    let folder = tempfile::tempdir().unwrap();
    let rule =
        "initiator: segment\ngenerator: koch\nsteps: 1\nstyle: {stroke: red, background: blue}\n";
    fs::write(folder.path().join("k.yaml"), rule).unwrap();
    let picture = |options: &[&str]| {
        let arguments = [&["grow", "k.yaml", "-o", "-", "--format", "svg"], options].concat();
        stdout(&run(folder.path(), &arguments).success())
    };
    let own = picture(&[]);
    assert!(own.contains("#ff0000") && own.contains("#0000ff"), "{own}");
    let none = picture(&["--stroke", "none", "--background", "none"]);
    let drawn = none.split("<metadata").next().unwrap();
    assert!(
        !drawn.contains("#ff0000") && !drawn.contains("#0000ff"),
        "{none}"
    );
    assert!(none.contains("--stroke=none") && none.contains("--background=none"));
}

#[test]
fn folders_of_ones_own_come_before_the_library() {
    let folder = tempfile::tempdir().unwrap();
    let write = |path: &str, title: &str| {
        let path = folder.path().join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        let text = format!(
            "title: {title}\ninitiator: segment\ngenerator: [[0, 0], [1/2, 1/3], [1, 0]]\n"
        );
        fs::write(path, text).unwrap();
    };
    let title = |arguments: &[&str]| {
        let info = kfrac(folder.path())
            .env("KFRAC_LIBRARY", folder.path().join("environment"))
            .args(["info", "koch", "--json"])
            .args(arguments)
            .assert()
            .success();
        let info: serde_json::Value = serde_json::from_str(&stdout(&info)).unwrap();
        info["title"].as_str().unwrap().to_owned()
    };
    assert_eq!(title(&[]), "Koch curve");
    write("data/kfrac/rules/koch.yaml", "data");
    assert_eq!(title(&[]), "data");
    write("environment/rules/koch.yaml", "environment");
    assert_eq!(title(&[]), "environment");
    write("given/koch.yaml", "given");
    assert_eq!(title(&["--library", "given"]), "given");
    // An existing file has precedence.
    write("koch", "here");
    assert_eq!(title(&["--library", "given"]), "here");
}

#[test]
fn the_library_is_listed_as_a_page_with_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let library = folder.path().join("mine/rules");
    fs::create_dir_all(&library).unwrap();
    let own = "title: Gosper & <mine> \"x\"\ninitiator: segment\ngenerator: [[0, 0], [1/2, 1/3], [1, 0]]\n";
    fs::write(library.join("my-gosper.yaml"), own).unwrap();
    fs::write(
        library.join("bad-gosper.yaml"),
        "title: Gosper\ninitiator: [",
    )
    .unwrap();
    let listed = [
        "list",
        "gosper",
        "--library",
        "mine",
        "--html",
        "made/gallery",
    ];
    let said = stderr(&run(folder.path(), &listed).success());
    assert!(said.contains("bad-gosper has no picture"), "{said}");
    let made = folder.path().join("made/gallery");
    let page = fs::read_to_string(made.join("index.html")).unwrap();
    assert!(page.starts_with("<!doctype html>") && page.ends_with("</html>\n"));
    assert!(
        page.contains("<h3>Gosper &amp; &lt;mine&gt; &quot;x&quot;</h3>"),
        "{page}"
    );
    assert!(page.contains("kfrac grow gosper-lsystem") && !page.contains("<script"));
    let mut pictures = 0;
    for part in page.split("<img src=\"").skip(1) {
        let name = part.split('"').next().unwrap();
        assert!(
            fs::read(made.join(name)).unwrap().starts_with(b"\x89PNG"),
            "{name}"
        );
        pictures += 1;
    }
    assert_eq!(pictures + 1, page.matches("<li>").count());
    assert_eq!(pictures, files(&made).len() - 1);
    assert!(pictures > 2);
    // A component is shown by a rule that uses it; nothing found makes no page.
    run(folder.path(), &["list", "koch", "--html", "koch"]).success();
    assert!(folder.path().join("koch/generators-koch.png").exists());
    run(folder.path(), &["list", "zzz", "--html", "none"]).failure();
    assert!(!folder.path().join("none").exists());
}

#[test]
fn the_library_is_listed_with_rules_and_components() {
    let folder = tempfile::tempdir().unwrap();
    let list = run(folder.path(), &["list", "--json"]).success();
    let list: serde_json::Value = serde_json::from_str(&stdout(&list)).unwrap();
    let koch = list
        .as_array()
        .unwrap()
        .iter()
        .find(|row| row["name"] == "koch" && row["kind"] == "rule");
    assert_eq!(koch.unwrap()["path"], "embedded");
    assert_eq!(koch.unwrap()["title"], "Koch curve");
    for kind in ["rule", "initiator", "generator", "base_element"] {
        assert!(
            list.as_array()
                .unwrap()
                .iter()
                .any(|row| row["kind"] == kind),
            "{kind}"
        );
    }
    let dragons = stdout(&run(folder.path(), &["list", "dragon"]).success());
    assert!(dragons.contains("terdragon") && !dragons.contains("koch"));
}

/// Listed components can be shown, and growing a component is refused with its kind.
#[test]
fn components_are_shown_and_printed() {
    const COMPONENTS: [&str; 3] = ["initiator", "generator", "base_element"];
    let folder = tempfile::tempdir().unwrap();
    let listed = stdout(&run(folder.path(), &["list", "--json"]).success());
    let listed: Vec<serde_json::Value> = serde_json::from_str(&listed).unwrap();
    let mut components = 0;
    for entry in &listed {
        let [name, kind] = ["name", "kind"].map(|key| entry[key].as_str().unwrap());
        let shelf = match kind {
            "initiator" => "initiators",
            "generator" => "generators",
            "base_element" => "base_elements",
            _ => continue,
        };
        components += 1;
        let file = fs::read_to_string(format!("library/{shelf}/{name}.yaml")).unwrap();
        let (_, file) = file.split_once('\n').unwrap();
        let has_rule = listed.iter().any(|other| {
            other["name"] == *name && !COMPONENTS.contains(&other["kind"].as_str().unwrap())
        });
        let long = format!("{shelf}/{name}");
        assert_eq!(stdout(&run(folder.path(), &["cat", &long]).success()), file);
        // The first component of a name is taken, unless a rule has that name.
        let short = stdout(&run(folder.path(), &["cat", name]).success());
        let same = COMPONENTS.iter().find(|kind| {
            listed
                .iter()
                .any(|other| other["name"] == *name && other["kind"] == **kind)
        });
        if !has_rule && same == Some(&kind) {
            assert_eq!(short, file, "{name}");
        }
        // Growing is refused with the component's kind.
        let grown = run(folder.path(), &["grow", &long]).code(1);
        let said = String::from_utf8(grown.get_output().stderr.clone()).unwrap();
        let noun = kind.replace('_', " ");
        assert!(said.contains(&format!("'{name}' is a")), "{said}");
        assert!(
            said.contains(&format!("{noun}: a component of rules")),
            "{said}"
        );
        assert!(said.contains(&format!("`{kind}: {name}`")), "{said}");
    }
    assert_eq!(components, 60);
    run(
        folder.path(),
        &["check", "swaying-roof", "leaf", "generators/koch"],
    )
    .success();
    for (component, file, texts) in [
        (
            "generators/koch",
            "koch-generator.svg",
            ["generator", "fertile"],
        ),
        (
            "six-ways",
            "six-ways-initiator.svg",
            ["initiator", "fertile"],
        ),
        (
            "leaf",
            "leaf-base-element.svg",
            ["base element", "the element that is drawn so"],
        ),
    ] {
        run(folder.path(), &["show", component]).success();
        let svg = fs::read_to_string(folder.path().join(file)).unwrap();
        for heading in COMPONENTS.map(|kind| kind.replace('_', " ")) {
            let label = format!("aria-label=\"{heading}\"");
            assert_eq!(
                svg.contains(&label),
                heading == texts[0],
                "{component}: {heading}"
            );
        }
        assert!(svg.contains(texts[1]), "{component}");
    }
    let set = ["show", "swaying-roof", "--set", "sway=40", "-o", "roof.png"];
    run(folder.path(), &set).success();
    // Unknown parameters of components are refused, as those of rules are.
    run(folder.path(), &["show", "swaying-roof", "--set", "sawy=40"]).code(2);
}

#[test]
fn schemas_are_printed() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, schema) in [
        (&["schema"][..], &*kfrac::document::schema_of_all()),
        (
            &["schema", "rule"],
            include_str!("../library/schema/rule.json"),
        ),
        (
            &["schema", "base-element"],
            include_str!("../library/schema/base_element.json"),
        ),
    ] {
        assert_eq!(stdout(&run(folder.path(), arguments).success()), schema);
    }
    run(folder.path(), &["schema", "style"]).code(2);
}

#[test]
fn a_rule_is_printed_as_it_is_or_with_everything_in_it() {
    let folder = tempfile::tempdir().unwrap();
    let plain = stdout(&run(folder.path(), &["cat", "vegetation"]).success());
    let file = include_str!("../library/rules/vegetation.yaml");
    // The line that refers the library's file to its schema is left out.
    assert_eq!(plain, file.split_once('\n').unwrap().1);
    assert!(plain.starts_with("title: "));
    let inline = stdout(&run(folder.path(), &["cat", "pythagoras-30", "--inline"]).success());
    assert!(!inline.contains("extends") && inline.contains("- [0, 0]"));
    // The inlined rule draws the same picture.
    let csv = |rule: &str, input: &str| {
        let assert = kfrac(folder.path())
            .args(["grow", rule, "--steps", "4", "--format", "csv", "-o", "-"])
            .write_stdin(input)
            .assert()
            .success();
        stdout(&assert)
    };
    assert_eq!(csv("-", &inline), csv("pythagoras-30", ""));
}

#[test]
fn a_picture_tells_how_to_make_it_again() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = [
        "grow",
        "random-tree",
        "--steps",
        "5",
        "--seed",
        "7",
        "--set",
        "sway=20",
        "--size",
        "300x200",
        "--color-by",
        "generator",
        "--margin",
        "3",
        "--background",
        "#abcd",
    ];
    run(folder.path(), &arguments).success();
    let path = folder.path().join("random-tree.svg");
    let first = fs::read_to_string(&path).unwrap();
    let start = first.find("<metadata>\n").unwrap() + "<metadata>\n".len();
    let end = first.find("</metadata>").unwrap();
    let text = first[start..end]
        .replace("&lt;", "<")
        .replace("&gt;", ">")
        .replace("&amp;", "&");
    let command = text
        .lines()
        .find(|line| line.starts_with("# kfrac grow"))
        .unwrap()
        .to_owned();
    fs::write(folder.path().join("random-tree.yaml"), text).unwrap();
    fs::remove_file(&path).unwrap();
    let words: Vec<_> = command
        .split_whitespace()
        .skip(2)
        .map(|word| word.replace('\'', ""))
        .collect();
    let words: Vec<_> = words.iter().map(String::as_str).collect();
    run(folder.path(), &words).success();
    assert_eq!(fs::read_to_string(&path).unwrap(), first);
}

#[test]
fn a_rule_is_shown_as_a_figure() {
    let folder = tempfile::tempdir().unwrap();
    let shown = run(folder.path(), &["show", "dragon.yaml"]).success();
    let said = stderr(&shown);
    assert!(
        said.starts_with("dragon-rule.svg: the rule of dragon, ") && said.lines().count() == 1,
        "{said}"
    );
    let svg = fs::read_to_string(folder.path().join("dragon-rule.svg")).unwrap();
    assert!(
        svg.contains(r#"aria-label="odd i: gen0""#) && svg.contains("# kfrac show dragon.yaml")
    );
    let arguments = [
        "show",
        "cesaro",
        "--set",
        "angle=60",
        "--size=300",
        "--background=teal",
        "-o",
        "c.png",
        "-q",
    ];
    let shown = run(folder.path(), &arguments).success();
    assert_eq!(stderr(&shown), "");
    let png = fs::read(folder.path().join("c.png")).unwrap();
    assert!(png.starts_with(b"\x89PNG") && png[16..20] == 300u32.to_be_bytes());
    assert_eq!(files(folder.path()), ["c.png", "dragon-rule.svg"]);
    let unknown = run(folder.path(), &["show", "koch", "-o", "koch.gif"]).code(2);
    assert!(stderr(&unknown).contains("the format '.gif' is not known here"));
}

#[test]
fn check_tells_all_that_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("wrong.yaml"),
        "initiator: segmnt\ngenerator:\n  - [0, 0]\n  - {to: [1/2, 1/0], fertil: false}\n  - [1, 0]\n",
    )
    .unwrap();
    let check = run(folder.path(), &["check", "koch", "wrong.yaml", "--json"]).code(1);
    let rows: serde_json::Value = serde_json::from_str(&stdout(&check)).unwrap();
    let places: Vec<_> = rows
        .as_array()
        .unwrap()
        .iter()
        .map(|row| (&row["line"], &row["column"]))
        .collect();
    assert_eq!(
        serde_json::to_string(&places).unwrap(),
        "[[1,12],[4,18],[4,22]]"
    );
    assert!(
        rows.as_array()
            .unwrap()
            .iter()
            .all(|row| row["severity"] == "error" && row["file"] == "wrong.yaml")
    );
    assert_eq!(
        stdout(&run(folder.path(), &["check", "koch"]).success()),
        "koch: ok\n"
    );
}

#[test]
fn an_existing_file_is_replaced_as_a_whole_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("koch.svg");
    fs::write(&path, "old").unwrap();
    run(folder.path(), &["grow", "koch", "--margin", "600"]).code(1);
    assert_eq!(fs::read_to_string(&path).unwrap(), "old");
    run(folder.path(), &["grow", "koch"]).success();
    assert!(fs::read_to_string(&path).unwrap().ends_with("</svg>\n"));
    assert_eq!(files(folder.path()), ["koch.svg"]);
}

/// Files of many chunks are equal to the byte.
#[test]
fn what_is_written_does_not_depend_on_the_threads() {
    let folder = tempfile::tempdir().unwrap();
    for (rule, steps) in [
        ("koch", "8"),
        ("dragon", "15"),
        ("vegetation", "14"),
        ("carpet", "5"),
    ] {
        for format in ["svg", "png", "csv", "json"] {
            let mut written = ["1", "2", "5"].map(|threads| {
                let file = folder.path().join("file");
                let arguments = [
                    "grow", rule, "--steps", steps, "--size", "500", "-o", "file",
                ];
                kfrac(folder.path())
                    .args(arguments)
                    .args(["--format", format, "--threads", threads])
                    .assert()
                    .success();
                fs::read(file).unwrap()
            });
            let one = std::mem::take(&mut written[0]);
            assert!(one == written[1] && one == written[2], "{rule} as {format}");
        }
    }
}

#[cfg(unix)]
#[test]
fn a_closed_pipe_is_no_failure() {
    let folder = tempfile::tempdir().unwrap();
    for format in ["csv", "json", "svg", "png"] {
        let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin("kfrac"))
            .current_dir(folder.path())
            .args([
                "grow", "dragon", "--steps", "14", "--size", "2000", "-o", "-",
            ])
            .args(["--format", format])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        assert_eq!(child.wait().unwrap().code(), Some(0), "{format}");
    }
}

#[cfg(unix)]
#[test]
fn a_file_that_is_replaced_keeps_its_mode_and_a_link_stays_one() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("private.svg"), "old").unwrap();
    fs::set_permissions(path("private.svg"), fs::Permissions::from_mode(0o600)).unwrap();
    run(folder.path(), &["grow", "koch", "-o", "private.svg"]).success();
    assert_eq!(
        fs::metadata(path("private.svg"))
            .unwrap()
            .permissions()
            .mode()
            & 0o777,
        0o600
    );
    symlink("target.svg", path("link.svg")).unwrap();
    run(folder.path(), &["grow", "koch", "-o", "link.svg"]).success();
    assert!(path("link.svg").symlink_metadata().unwrap().is_symlink());
    assert!(path("target.svg").metadata().unwrap().is_file());
}

#[test]
fn what_numbers_cannot_tell_is_an_error_and_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let far = "initiator: segment\ngenerator: [[0, 0], [1e200, 0], [1e200, 1e200]]\n";
    fs::write(folder.path().join("far.yaml"), far).unwrap();
    for format in ["svg", "csv", "json"] {
        let far = run(
            folder.path(),
            &["grow", "far.yaml", "--steps", "3", "--format", format],
        )
        .code(1);
        assert!(!stderr(&far).is_empty());
    }
    let close = run(
        folder.path(),
        &["grow", "koch", "--view", "0.5,0,1e-17,1e-17"],
    )
    .code(1);
    assert!(
        stderr(&close).contains("the window is too small"),
        "{}",
        stderr(&close)
    );
    let infinite = "initiator: segment\ngenerator: [[0, 0], [1/2, 1/(step - 2)], [1, 0]]\n";
    fs::write(folder.path().join("infinite.yaml"), infinite).unwrap();
    run(
        folder.path(),
        &["info", "infinite.yaml", "--steps", "2", "--json"],
    )
    .success();
    let infinite = run(folder.path(), &["grow", "infinite.yaml", "--steps", "3"]).code(1);
    assert!(
        stderr(&infinite).contains("infinite.yaml:2:27"),
        "{}",
        stderr(&infinite)
    );
    assert_eq!(files(folder.path()), ["far.yaml", "infinite.yaml"]);
}

#[test]
fn a_limit_is_met_by_elements_and_by_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    // One element at every step, and one more seed at every step.
    fs::write(
        folder.path().join("one.yaml"),
        "initiator: segment\ngenerator: [[0, 0], [0.99, 0]]\n",
    )
    .unwrap();
    run(
        folder.path(),
        &["grow", "one.yaml", "--steps", "3000", "--max-elements", "1"],
    )
    .success();
    let seeding = "initiator: segment\ngenerator:\n  parts:\n    - elements: [[0, 0], [0.99, 0]]\n    \
                   - {seeds: true, elements: [{from: [0, 0], to: [0, 0.5], fertile: false}]}\n";
    fs::write(folder.path().join("seeding.yaml"), seeding).unwrap();
    run(
        folder.path(),
        &[
            "grow",
            "seeding.yaml",
            "--steps",
            "300",
            "--max-elements",
            "301",
        ],
    )
    .success();
    run(
        folder.path(),
        &[
            "grow",
            "seeding.yaml",
            "--steps",
            "300",
            "--max-elements",
            "300",
        ],
    )
    .code(1);
    // Counts are known where only points depend on the index.
    let by_index = "initiator: segment\ngenerator: [[0, 0], [0.5, i/1000], [1, 0]]\n";
    fs::write(folder.path().join("by_index.yaml"), by_index).unwrap();
    let refused = run(folder.path(), &["grow", "by_index.yaml", "--steps", "30"]).code(1);
    assert!(
        stderr(&refused).contains("1,073,741,824 elements; 25 is the deepest"),
        "{}",
        stderr(&refused)
    );
}

#[cfg(unix)]
#[test]
fn who_ends_the_program_leaves_nothing_behind() {
    let folder = tempfile::tempdir().unwrap();
    let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin("kfrac"))
        .current_dir(folder.path())
        .args(["grow", "koch", "--steps", "12", "--format", "csv"])
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    // The command is under way once the table's temporary file exists.
    while files(folder.path()).is_empty() {
        assert!(
            child.try_wait().unwrap().is_none(),
            "it ended before it could be interrupted"
        );
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let killed = std::process::Command::new("sh")
        .args(["-c", &format!("kill {}", child.id())])
        .status()
        .unwrap();
    assert!(killed.success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(files(folder.path()), [""; 0]);
}

#[test]
fn a_picture_and_its_depths_are_written_together_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    let grow = |arguments: &[&str]| {
        let common = ["grow", "menger", "--steps", "2", "--size", "40"];
        run(folder.path(), &[&common, arguments].concat())
    };
    for chaos in [&[][..], &["--method", "chaos", "--points", "2000"]] {
        let common = [
            "grow", "menger", "--size", "40", "-o", "a.png", "--depth", "b.png",
        ];
        run(folder.path(), &[&common[..], chaos].concat()).success();
        assert_eq!(files(folder.path()), ["a.png", "b.png"]);
        let depths = fs::read(folder.path().join("b.png")).unwrap();
        assert_eq!(depths[24..26], [16, 0]); // 16 bits, grey
        fs::remove_file(folder.path().join("a.png")).unwrap();
        fs::remove_file(folder.path().join("b.png")).unwrap();
    }
    for wrong in [
        ["-o", "a.png", "--depth", "a.png"],
        ["-o", "a.png", "--depth", "none/b.png"],
        ["-o", "none/a.png", "--depth", "b.png"],
        ["-o", "a.csv", "--depth", "b.png"],
    ] {
        grow(&wrong).failure();
        assert!(files(folder.path()).is_empty(), "{wrong:?}");
    }
    let plane = run(folder.path(), &["grow", "koch", "--depth", "b.png"]).failure();
    assert!(stderr(&plane).contains("--depth applies to sets in space"));
}

#[test]
fn options_without_bounds_or_effect_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let rows = (0..20).map(|row| {
        if row < 10 {
            "1".repeat(8) + "0000"
        } else {
            "0".repeat(12)
        }
    });
    let picture = format!("P1\n12 20\n{}\n", rows.collect::<Vec<_>>().join("\n"));
    fs::write(folder.path().join("a.pbm"), picture).unwrap();
    fs::write(folder.path().join("a.csv"), "x,y\n1,2\n3,4\n5,7\n").unwrap();
    let cases: [(&[&str], &str); 5] = [
        (
            &["dim", "koch", "--grids", "1000000000000000000"],
            "from 1 to 1000",
        ),
        (
            &["dim", "a.csv", "--columns", "1,1"],
            "a column is given twice",
        ),
        (
            &["fit", "a.pbm", "--branch", "5,5", "--method", "collage"],
            "--branch is for --method skeleton, not collage",
        ),
        (
            &["fit", "a.pbm", "--centre", "5,5", "--method", "moments"],
            "--centre is for --method skeleton",
        ),
        (
            &["fit", "a.pbm", "--branch", "5,50"],
            "--branch 5,50 lies outside of the picture of 12 x 20 pixels",
        ),
    ];
    for (arguments, said) in cases {
        let refused = run(folder.path(), arguments).failure();
        assert!(stderr(&refused).contains(said), "{}", stderr(&refused));
    }
}
