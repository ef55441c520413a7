//! Promise: `firsthit report` counts what is wrong as it is, says it to people and to programs,
//! draws it, and leaves no half file.

use std::collections::BTreeSet;
use std::process::{Command, Stdio};
use std::sync::LazyLock;

use firsthit::camera::frame_angle;
use firsthit::{Kernel, Scene, Stage};
use serde_json::Value;
use tempfile::TempDir;

use crate::helpers::{
    self, hard_scene_text, hard_scenes, printed, program, trace_with_decisions, without_drivers,
};

/// What `firsthit report` with the words of `line` printed, without the drivers of OpenGL; it must
/// have succeeded and said nothing else.
fn report(folder: &TempDir, line: &str) -> String {
    let line = format!("report {line}");
    let output = without_drivers(folder, &line).output().unwrap();
    helpers::succeeded(&output, &line)
}

/// What it said when it failed with `status`.
fn failed(folder: &TempDir, line: &str, status: i32) -> String {
    let output = program(folder, &format!("report {line}")).output().unwrap();
    assert!(output.stdout.is_empty(), "{line}");
    helpers::failed(&output, status, line)
}

fn read(folder: &TempDir, name: &str) -> String {
    std::fs::read_to_string(folder.path().join(name)).unwrap()
}

fn json(folder: &TempDir, name: &str) -> Value {
    serde_json::from_str(&read(folder, name)).unwrap()
}

fn is_empty(folder: &TempDir) -> bool {
    folder.path().read_dir().unwrap().next().is_none()
}

/// The errors of a kernel over the first two frames of the built-in scene at N = 16, counted
/// without the report.
fn counted(kernel: Kernel) -> (u64, u64) {
    let (mut wrong, mut misrounded) = (0, 0);
    for alpha in [0, 1].map(frame_angle) {
        let trace =
            |kernel| trace_with_decisions(kernel, &Scene::builtin(), Stage::Reflection, alpha, 16);
        let (image, decisions) = trace(kernel);
        let (truth, true_decisions) = trace(Kernel::Exact);
        wrong += decisions
            .iter()
            .zip(&true_decisions)
            .filter(|(a, b)| a != b)
            .count() as u64;
        let samples = image.samples().iter().zip(truth.samples());
        misrounded += samples.filter(|(a, b)| a.to_bits() != b.to_bits()).count() as u64;
    }
    (wrong, misrounded)
}

const ALL: &str =
    "--kernel exact --kernel fast --kernel double --kernel listing --kernel reference";

#[test]
fn the_json_is_as_promised() {
    let folder = tempfile::tempdir().unwrap();
    printed(
        &folder,
        &format!("report --size 16 --frames 0..1 --threads 2 --json r.json {ALL}"),
    );
    let report = json(&folder, "r.json");
    assert_eq!(report["version"], 1);
    for key in [
        "cpu", "features", "simd", "threads", "cores", "version", "commit",
    ] {
        assert!(report["machine"].get(key).is_some(), "{key}");
    }
    let rows = report["rows"].as_array().unwrap();
    let kinds: Vec<_> = rows
        .iter()
        .map(|row| {
            (
                row["kernel"].as_str().unwrap(),
                row["threads"].as_u64().unwrap(),
            )
        })
        .collect();
    let expected: Vec<_> = Kernel::ALL
        .iter()
        .flat_map(|kernel| [1, 2].map(|threads| (kernel.name(), threads)))
        .collect();
    assert_eq!(kinds, expected);
    for row in rows {
        assert_eq!(row["scene"], "builtin");
        assert_eq!(
            (&row["stage"], &row["size"], &row["frames"]),
            (&6.into(), &16.into(), &2.into())
        );
        assert!(row["simd"].is_string());
        for key in ["ms", "fill_ratio", "retained_fill_ratio"] {
            let [min, median, max] =
                ["min", "median", "max"].map(|end| row[key][end].as_f64().unwrap());
            assert!(0.0 < min && min <= median && median <= max, "{key}: {row}");
        }
        for key in ["mean_ulp", "max_abs"] {
            assert!(row[key].is_f64(), "{key}: {row}");
        }
        for key in ["max_ulp", "eight_bit_differences", "pixels_in_doubt"] {
            assert!(row[key].is_u64(), "{key}: {row}");
        }
        let name = row["kernel"].as_str().unwrap();
        let kernel = Kernel::ALL
            .into_iter()
            .find(|kernel| kernel.name() == name)
            .unwrap();
        // The others go pixel by pixel.
        let by_rows = [Kernel::Exact, Kernel::Fast, Kernel::Double].contains(&kernel);
        for key in ["edges_a_row", "spans_a_row"] {
            assert_eq!(row[key].as_f64().unwrap() > 1.0, by_rows, "{key}: {row}");
        }
        let (wrong, misrounded) = counted(kernel);
        assert_eq!(
            (&row["wrong_pixels"], &row["misrounded"]),
            (&wrong.into(), &misrounded.into()),
            "{name}"
        );
        match kernel {
            Kernel::Exact | Kernel::Reference => assert_eq!(wrong + misrounded, 0),
            Kernel::Fast => assert!(misrounded > 0),
            Kernel::Listing => assert!(wrong > 0),
            Kernel::Double => {}
        }
    }
    let pipeline = report["pipeline"].as_array().unwrap();
    let ways: Vec<_> = pipeline
        .iter()
        .map(|way| [&way["context"], &way["path"]])
        .collect();
    let all = [
        ["egl", "texture"],
        ["egl", "glDrawPixels"],
        ["osmesa", "texture"],
        ["osmesa", "glDrawPixels"],
    ];
    assert!(
        ways.iter().zip(all).all(|(way, expected)| *way == expected),
        "{ways:?}"
    );
    for way in pipeline {
        for key in ["upload_ms", "draw_ms", "readback_ms"] {
            let measured = way[key].is_f64() && way["missing"].is_null();
            let missing = way[key].is_null() && way["missing"].is_string();
            assert!(measured || missing, "{way}");
        }
    }
}

#[test]
fn the_table_has_every_row_and_no_line_longer_than_another_of_its_kind() {
    let folder = tempfile::tempdir().unwrap();
    let table = printed(
        &folder,
        "report --size 8 --frames 3..3 --threads 1 --stage 1 --stage 5",
    );
    for stage in ["1", "5"] {
        for kernel in ["exact", "fast", "double", "listing"] {
            let rows = table.lines().filter(|line| {
                line.split_whitespace()
                    .take(3)
                    .eq(["builtin", stage, kernel])
            });
            // Once among the times, once among the errors, and its numbers end where their columns
            // do.
            let widths: Vec<usize> = rows.map(|row| row.chars().count()).collect();
            assert_eq!(widths.len(), 2, "{stage} {kernel}\n{table}");
        }
    }
    let widths: BTreeSet<usize> = table
        .lines()
        .filter(|line| line.starts_with("builtin"))
        .map(|line| line.chars().count())
        .collect();
    assert_eq!(widths.len(), 2, "{table}");
    assert!(!table.contains("2 threads"), "{table}");
}

/// What the JSON says of a kernel on a crowd or on the built-in scene.
struct Scaling {
    /// Scene, number of spheres, kernel.
    name: (String, u64, String),
    threads: u64,
    ms: f64,
    ratio: f64,
}

fn scalings(report: &Value) -> Vec<Scaling> {
    let rows = report["crowds"].as_array().unwrap().iter();
    let text = |value: &Value| value.as_str().unwrap().to_owned();
    let scalings = rows.map(|row| {
        let [min, ms, max] = ["min", "median", "max"].map(|end| row["ms"][end].as_f64().unwrap());
        assert!(0.0 < min && min <= ms && ms <= max, "{row}");
        assert!(row["samples"].as_u64() >= Some(3), "{row}");
        assert_eq!(
            (&row["stage"], &row["size"], &row["frames"]),
            (&5.into(), &8.into(), &2.into())
        );
        Scaling {
            name: (
                text(&row["scene"]),
                row["spheres"].as_u64().unwrap(),
                text(&row["kernel"]),
            ),
            threads: row["threads"].as_u64().unwrap(),
            ms,
            ratio: row["ratio"].as_f64().unwrap(),
        }
    });
    scalings.collect()
}

const CROWDS: &str = "--crowd 90,3,90 --size 8 --frames 0..1 --threads 2 --stage 5 --stage 1 \
                      --kernel listing --kernel double --kernel exact";

/// A report on some crowds.
struct CrowdReport {
    table: String,
    json: Value,
    plot: String,
}

static CROWD_REPORT: LazyLock<CrowdReport> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    CrowdReport {
        table: report(&folder, &format!("{CROWDS} --json r.json --plot p.svg")),
        json: json(&folder, "r.json"),
        plot: read(&folder, "p.svg"),
    }
});

#[test]
fn each_crowd_has_its_time_by_that_of_the_built_in_scene() {
    let CrowdReport {
        table,
        json: report,
        ..
    } = &*CROWD_REPORT;
    let scalings = scalings(report);
    let scenes = [("builtin", 2), ("crowd", 3), ("crowd", 90)];
    let expected = ["double", "exact"].into_iter().flat_map(|kernel| {
        let rows = scenes.map(|(scene, spheres)| (scene.to_owned(), spheres, kernel.to_owned()));
        rows.into_iter()
            .flat_map(|name| [1, 2].map(|threads| (name.clone(), threads)))
    });
    let names = scalings.iter().map(|row| (row.name.clone(), row.threads));
    assert!(names.eq(expected), "{report}");

    let (_, table) = table
        .split_once("time a frame against the number of spheres, stage 5\n")
        .unwrap();
    let (table, _) = table.split_once("\n\n").unwrap();
    // Two lines of titles, and a line for both numbers of threads.
    assert_eq!(table.lines().count(), 2 + scalings.len() / 2, "{table}");
    for row in &scalings {
        let is_base = |base: &&Scaling| {
            let (kernel, threads) = (&row.name.2, row.threads);
            base.name.0 == "builtin" && base.name.2 == *kernel && base.threads == threads
        };
        let base = scalings.iter().find(is_base).unwrap();
        let is_near = |a: f64, b: f64, part: f64| (a - b).abs() <= part * b;
        assert!(is_near(row.ratio, row.ms / base.ms, 1e-9), "{report}");

        let (scene, spheres, kernel) = &row.name;
        let names = [scene, &spheres.to_string(), kernel];
        let mut lines = table.lines();
        let line = lines.find(|line| line.split_whitespace().take(3).eq(names));
        let group = line.unwrap().split('│').nth(row.threads as usize).unwrap();
        let cells: Vec<&str> = group.split_whitespace().collect();
        let shown = |cell: &str| cell.parse::<f64>().unwrap();
        assert!(is_near(shown(cells[0]), row.ms, 0.01), "{table}\n{report}");
        let ratio = shown(cells.last().unwrap());
        assert!(is_near(ratio, row.ratio, 0.01), "{table}\n{report}");
    }
    // What takes many times as long takes longer on any machine.
    let largest = scalings.iter().find(|row| row.name.1 == 90).unwrap();
    assert!(largest.ratio > 1.5, "{report}");
}

/// Where the marks of a kernel stand in the last of two panels: the middle of each outline in the
/// kernel's colour that is drawn in full size.
fn marks(plot: &roxmltree::Document<'_>, color: &str) -> Vec<[f64; 2]> {
    let in_color = plot
        .descendants()
        .filter(|node| node.attribute("stroke") == Some(color));
    let number = |text: &str| text.parse::<f64>().unwrap();
    let marks = in_color.filter_map(|node| {
        if node.attribute("r") == Some("8") {
            return Some(["cx", "cy"].map(|name| number(node.attribute(name).unwrap())));
        }
        let points = node.attribute("points")?.split_whitespace();
        let corners: Vec<[f64; 2]> = points
            .map(|point| point.split_once(',').unwrap())
            .map(|(x, y)| [number(x), number(y)])
            .collect();
        let &[low, _, high, _, last] = &corners[..] else {
            return None;
        };
        (low == last).then(|| [0, 1].map(|axis| (low[axis] + high[axis]) / 2.0))
    });
    let (left, legend) = (680.0, 478.0);
    marks.filter(|&[x, y]| x > left && y < legend).collect()
}

#[test]
fn each_crowd_is_in_the_plot() {
    let plot = roxmltree::Document::parse(&CROWD_REPORT.plot).unwrap();
    for label in [
        "Time against the number of spheres",
        "built-in scene",
        "spheres",
    ] {
        let is_label = |node: roxmltree::Node<'_, '_>| node.text().map(str::trim) == Some(label);
        assert!(plot.descendants().any(is_label), "{label}");
    }
    let scalings = scalings(&CROWD_REPORT.json);
    let mut places = Vec::new();
    for (kernel, color) in [("exact", "#0072B2"), ("double", "#009E73")] {
        let rows = scalings
            .iter()
            .filter(|row| row.name.2 == kernel && row.threads == 1);
        let marks = marks(&plot, color);
        assert_eq!(marks.len(), rows.clone().count(), "{kernel}");
        places.extend(rows.zip(marks).map(|(row, mark)| {
            let values = [row.name.1 as f64, row.ms].map(f64::log10);
            (values, mark)
        }));
    }
    // Both scales are logarithmic: two places of each tell where the others are.
    for (axis, sign) in [(0, 1.0), (1, -1.0)] {
        let places = places
            .iter()
            .map(|(values, mark)| (values[axis], mark[axis]));
        let order = |a: &(f64, f64), b: &(f64, f64)| a.0.total_cmp(&b.0);
        let low = places.clone().min_by(order).unwrap();
        let high = places.clone().max_by(order).unwrap();
        let decade = (high.1 - low.1) / (high.0 - low.0);
        assert!(sign * decade > 50.0, "{decade} pixels a decade");
        for (value, pixel) in places {
            let expected = low.1 + decade * (value - low.0);
            assert!(
                (pixel - expected).abs() < 2.0,
                "{pixel} instead of {expected}"
            );
        }
    }
}

#[test]
fn without_crowds_the_report_knows_of_none() {
    let folder = tempfile::tempdir().unwrap();
    let table = report(
        &folder,
        "--size 2 --frames 0..0 --threads 1 --kernel fast --json r.json",
    );
    assert!(!table.contains("spheres"), "{table}");
    assert_eq!(scalings(&json(&folder, "r.json")).len(), 0);
}

#[test]
fn the_plot_is_xml_and_shows_every_kernel_and_every_group() {
    let folder = tempfile::tempdir().unwrap();
    // A name that XML would take for something else.
    let name = "a&b<c>.toml";
    std::fs::write(folder.path().join(name), hard_scene_text("highlights")).unwrap();
    report(
        &folder,
        &format!(
            "--size 8 --frames 1..1 --threads 1 --scene {name} --scene {name} --plot p.svg {ALL}"
        ),
    );
    let text = read(&folder, "p.svg");
    let plot = roxmltree::Document::parse(&text).unwrap();
    let texts: Vec<&str> = plot
        .descendants()
        .filter(|node| node.has_tag_name("text"))
        .filter_map(|node| node.text())
        .map(str::trim)
        .collect();
    for kernel in Kernel::ALL {
        // The listing refuses this scene.
        assert_eq!(
            texts.contains(&kernel.name()),
            kernel != Kernel::Listing,
            "{texts:?}"
        );
    }
    for label in [
        name,
        "Error against time",
        "time a frame, ms",
        "error of a sample, f32 steps",
        "fill with one colour",
        "0",
    ] {
        assert!(texts.contains(&label), "{label} in {texts:?}");
    }
}

#[test]
fn standard_output_gets_the_json_or_the_plot_in_place_of_the_tables() {
    let folder = tempfile::tempdir().unwrap();
    let line = "--size 2 --frames 0..0 --threads 1 --kernel double";
    let text = report(&folder, &format!("{line} --json -"));
    let value: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(value["version"], 1);
    // What is measured last is in it.
    assert!(!value["pipeline"].as_array().unwrap().is_empty());
    let text = report(&folder, &format!("{line} --plot -"));
    assert!(text.contains("Error against time"), "{text}");
    roxmltree::Document::parse(&text).unwrap();
    let message = failed(&folder, "--plot - --json -", 2);
    assert!(message.contains("two files"), "{message}");
    assert!(is_empty(&folder));
}

#[test]
fn a_scene_that_a_kernel_refuses_is_a_row_that_says_so() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("s.toml"), "background = [0.5, 0.5, 0.5]").unwrap();
    let table = report(
        &folder,
        "--scene s.toml --size 8 --frames 0..0 --threads 1 --kernel listing --kernel double --json r.json --plot p.svg",
    );
    let refused = table.lines().filter(|line| line.contains("refused"));
    assert_eq!(refused.count(), 3, "{table}");
    let report = json(&folder, "r.json");
    let rows = report["rows"].as_array().unwrap();
    assert!(
        rows[0]["refused"]
            .as_str()
            .unwrap()
            .contains("2 spheres, 1 tetrahedron")
    );
    assert!(rows[0]["ms"].is_null() && rows[0]["wrong_pixels"].is_null());
    assert_eq!(
        (&rows[1]["kernel"], &rows[1]["wrong_pixels"]),
        (&"double".into(), &0.into())
    );
    // Nothing at all to draw is a plot all the same.
    report_nothing(&folder);
}

fn report_nothing(folder: &TempDir) {
    report(
        folder,
        "--scene s.toml --size 8 --frames 0..0 --threads 1 --kernel listing --plot p.svg",
    );
    roxmltree::Document::parse(&read(folder, "p.svg")).unwrap();
}

#[test]
fn hard_scenes_join_the_built_in_one() {
    let folder = tempfile::tempdir().unwrap();
    report(
        &folder,
        "--hard --stage 2 --size 2 --frames 0..0 --threads 1 --kernel double --json r.json --plot p.svg",
    );
    let report = json(&folder, "r.json");
    let rows = report["rows"].as_array().unwrap();
    let scenes = rows.iter().map(|row| row["scene"].as_str().unwrap());
    let hard = hard_scenes();
    let expected = hard.iter().map(|name| &name[..]);
    assert!(scenes.eq(std::iter::once("builtin").chain(expected)));
    let plot = read(&folder, "p.svg");
    let hard = format!("{} hard scenes", hard.len());
    assert!(plot.contains("Built-in scene") && plot.contains(&hard));
}

/// What SIGINT leaves while the report is being measured: nothing.
#[cfg(unix)]
#[test]
fn ctrl_c_leaves_no_file() {
    use std::os::unix::process::ExitStatusExt;
    let folder = tempfile::tempdir().unwrap();
    let mut child = program(
        &folder,
        "report --frames 0..20000 --threads 1 --json r.json --plot p.svg",
    )
    .stdout(Stdio::null())
    .stderr(Stdio::null())
    .spawn()
    .unwrap();
    std::thread::sleep(std::time::Duration::from_millis(200));
    assert!(child.try_wait().unwrap().is_none(), "it is measuring");
    // Of a test in the background of a shell SIGINT may be ignored, and so it is of its children:
    // SIGTERM ends them alike.
    let kill = format!("kill -INT {0} && kill -TERM {0}", child.id());
    let killed = Command::new("sh").args(["-c", &kill]).status().unwrap();
    assert!(killed.success());
    let status = child.wait().unwrap();
    assert!(matches!(status.signal(), Some(2 | 15)), "{status}");
    assert!(is_empty(&folder));
}

#[test]
fn wrong_usage_is_2_and_failure_is_1_with_one_line_before_anything_is_measured() {
    let folder = tempfile::tempdir().unwrap();
    for line in [
        "--plot p.png",
        "--plot p",
        "--json p.svg --plot p.svg",
        "--stage 8",
        "--size 0",
        "--frames 3..2",
        "--kernel quick",
        "--threads -1",
        "file",
    ] {
        failed(&folder, line, 2);
    }
    for line in [
        "--crowd 0",
        "--crowd 4096",
        "--crowd x",
        "--crowd ",
        "--crowd 20,",
        "--crowd 20,0",
        "--crowd 20 --kernel listing --kernel reference",
    ] {
        let message = failed(&folder, line, 2);
        let (first, rest) = message.split_once('\n').unwrap();
        assert!(first.starts_with("error: "), "{line}: {message}");
        assert!(first.contains("--crowd"), "{line}: {message}");
        assert!(!rest.contains("crowd"), "{line}: {message}");
    }
    // Too many frames to be measured before the failure is noticed.
    for (line, says) in [
        ("--json none/r.json", "none/r.json: cannot be written"),
        ("--plot none/p.svg", "none/p.svg: cannot be written"),
        ("--json .", ".: this is a folder"),
        ("--scene none.toml", "none.toml: cannot be read"),
    ] {
        let message = failed(&folder, &format!("{line} --frames 0..20000"), 1);
        assert!(
            message.starts_with(&format!("firsthit: {says}")),
            "{message}"
        );
    }
    assert!(is_empty(&folder));
}

/// A folder with a program in it, `sh p.sh`, whose pictures are black.
#[cfg(unix)]
fn black() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let script = "while read line; do head -c 6912 /dev/zero; done";
    std::fs::write(folder.path().join("p.sh"), script).unwrap();
    folder
}

/// `firsthit report` on a program, with further words.
#[cfg(unix)]
fn report_on(command: &str, folder: &TempDir, line: &str) -> Command {
    let line = format!("report --size 24 --frames 0..1 {line}");
    let mut words = without_drivers(folder, &line);
    words.args(["--program", command]);
    words
}

#[cfg(unix)]
#[test]
fn another_programs_pixels_are_counted_by_what_is_wrong_with_them() {
    let folder = black();
    let mut command = report_on("sh p.sh", &folder, "--stage 5..6 --json a.json");
    let text = helpers::succeeded(&command.output().unwrap(), "report --program");
    assert!(text.contains("other renderers, over all frames"), "{text}");
    // Of the kernels only the truth is timed beside it.
    assert!(!text.contains("listing"), "{text}");
    let json = json(&folder, "a.json");
    let rows = json["renderers"].as_array().unwrap();
    assert_eq!(rows.len(), 2);
    for (row, stage) in rows.iter().zip([Stage::Shadow, Stage::Reflection]) {
        assert_eq!(row["renderer"], "sh p.sh");
        assert_eq!(row["stage"], stage.number());
        assert_eq!(row["frames"], 2);
        assert!(row["ms"]["median"].as_f64().unwrap() > 0.0);
        let count = |name: &str| row[name].as_u64().unwrap();
        let by_kind = row["wrong_by_kind"].as_object().unwrap();
        let wrong: u64 = by_kind.values().map(|count| count.as_u64().unwrap()).sum();
        assert_eq!(count("wrong_pixels"), wrong);
        // Whatever is nowhere darker than a byte is wrong.
        let mut bright = 0;
        for alpha in [0, 1].map(frame_angle) {
            let (truth, _) =
                trace_with_decisions(Kernel::Exact, &Scene::builtin(), stage, alpha, 24);
            let pixels = truth.samples().chunks_exact(3);
            bright += pixels
                .filter(|pixel| pixel.iter().any(|&sample| sample > 1.0 / 255.0))
                .count() as u64;
        }
        assert_eq!(wrong, bright);
        assert_eq!(
            count("right_pixels") + count("rounded_pixels"),
            2 * 576 - wrong
        );
        assert_eq!(by_kind["another_color"].as_u64().unwrap(), wrong);
    }
}

#[cfg(unix)]
#[test]
fn too_many_wrong_pixels_are_a_failure() {
    let folder = black();
    let run = |line: &str| report_on("sh p.sh", &folder, line).output().unwrap();
    let few = run("--stage 2 --stage 5..6 --max-wrong 3");
    let said = "firsthit: sh p.sh: stage 2 Spheres of builtin: 1152 wrong pixels, more than 3: see them in `firsthit view --program`, on E\n";
    assert_eq!(helpers::failed(&few, 1, "--max-wrong 3"), said);
    // The table comes all the same.
    assert!(helpers::text(&few.stdout).contains("other renderers"));
    helpers::succeeded(&run("--stage 5..6 --max-wrong 1152"), "--max-wrong 1152");
    // So far off is nothing.
    helpers::succeeded(
        &run("--stage 5 --max-wrong 0 --tolerance 2"),
        "--tolerance 2",
    );

    std::fs::write(folder.path().join("p.sh"), "exit 3").unwrap();
    let failing = run("--stage 5 --max-wrong 1152");
    let said = helpers::failed(&failing, 1, "a program that ends");
    assert!(said.contains("ended with status 3"), "{said}");
    let failing = helpers::succeeded(&run("--stage 5"), "a program that ends");
    assert!(failing.contains("failed: sh p.sh: stage 5"), "{failing}");
}

#[cfg(unix)]
#[test]
fn what_a_program_writes_after_its_last_picture_is_told_and_so_are_two_of_one_name() {
    let folder = black();
    let surplus = "while read line; do head -c 6912 /dev/zero; done; echo bye";
    std::fs::write(folder.path().join("q.sh"), surplus).unwrap();
    let mut command = report_on("sh q.sh", &folder, "--stage 5");
    let output = command.args(["--program", "sh q.sh"]).output().unwrap();
    let said = helpers::failed(&output, 1, "a program that says bye");
    assert!(said.contains("bye"), "{said}");
    let text = helpers::text(&output.stdout);
    assert!(
        text.contains("sh q.sh ") && text.contains("sh q.sh (2) "),
        "{text}"
    );
}

#[cfg(unix)]
#[test]
fn the_documents_own_code_earns_a_hint_at_its_slip() {
    let folder = tempfile::tempdir().unwrap();
    let Some(homework) = helpers::compiled("homework.c") else {
        return;
    };
    let words = "--stage 4 --json a.json --max-wrong 9999";
    let output = report_on(&homework, &folder, words).output().unwrap();
    let text = helpers::succeeded(&output, "report on homework.c");
    let hint = "light falls on the wrong side of solids: in n·l, l is the way toward the light";
    let line = format!("homework, builtin, stage 4: {hint}\n");
    assert!(text.contains(&line), "{text}");
    let json = json(&folder, "a.json");
    assert_eq!(json["renderers"][0]["hints"][0], hint);
}

#[test]
fn what_programs_are_graded_by_is_checked() {
    let folder = tempfile::tempdir().unwrap();
    for (line, part) in [
        ("--max-wrong 0", "--program"),
        ("--tolerance 0.1", "--program"),
        ("--program x --tolerance -1", "--tolerance"),
        (
            "--program x --tolerance nan",
            "a number from 0 on is needed",
        ),
        ("--program x --program-timeout 0", "--program-timeout"),
        ("--stage 6..2", "the first stage comes after the last"),
        ("--stage 1..8", "the stages are 1 to 7"),
    ] {
        let said = failed(&folder, line, 2);
        assert!(said.contains(part), "{line}: {said}");
    }
    assert!(is_empty(&folder));
}
