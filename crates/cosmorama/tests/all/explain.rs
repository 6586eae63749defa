//! Reports and figures: their numbers against the paper's and the lens's, their form against XML.

use cosmorama::camera::{FieldStop, OmnimaxFraming, PixelGrid, PixelPoint, View};
use cosmorama::explain::{Figures, Magnification, Report, Underlay};
use cosmorama::filter::FilterSettings;
use cosmorama::projection::ProjectionKind;
use cosmorama::render::{Accuracy, Arithmetic, Needs, Resampler};
use cosmorama::sphere::{CubeFace, Orientation};
use cosmorama::world::World;
use glam::DVec2;
use testkit::{cube, equirect, fisheye, omnimax, perspective, turned};

fn assert_close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found} is not {expected}");
}

#[test]
fn six_faces_to_omnimax() {
    let report = Report::of(&cube(&CubeFace::ALL, 1024, 1024), &omnimax(1966, 1436), &FilterSettings::DEFAULT);
    // The lens: 1.411269 rad a radius of 921.523 pixels at the centre; a texel of the front face is 2/1024 there.
    let (view, Magnification { least, greatest }) = report.centre.expect("a centre").view.expect("a view");
    let expected = 1.411269 / 921.523 * 512.0;
    assert_eq!(view, 0);
    assert_close(least, expected, 1e-6);
    assert_close(greatest, expected, 1e-6);
    let advised = report.views[0].advised.expect("a size");
    assert_eq!((advised.parity, advised.two_thirds), ((1306, 1306), (871, 871)));
    // At the rim the lens is steeper, 138.2°: across the middle of a side face, where a texel is 2/1024 again.
    let right = report.views[1].magnification.expect("a range");
    assert!(right.least < 0.6 && right.greatest > 138.2f64.to_radians() / 921.523 * 512.0 - 0.01, "{right:?}");
    assert_close(report.views[4].used, 0.5 + 1.45 / 1024.0, 5e-3);
    assert_close(report.views[3].used, report.views[1].used, 5e-3);
    assert_eq!((report.views[2].used, report.views[5].used), (0.0, 0.0));
    assert_close(report.views.iter().map(|view| view.share).sum(), 1.0, 1e-9);
    assert_eq!(report.memory.texels, 6 * 1024 * 1024 * 16);
    assert!(report.gathered.mean > 4.0 && report.gathered.most < 100, "{:?}", report.gathered);
}

#[test]
fn the_plan_is_estimated_well() {
    let panorama = |width| World::new([("panorama".to_owned(), equirect(width))]).expect("a world");
    for (world, target) in [
        (cube(&CubeFace::ALL, 128, 128), omnimax(246, 180)),
        (cube(&CubeFace::ALL, 64, 64), fisheye(700, 180.0)),
        // A pole and its seam in a few rows.
        (panorama(512), perspective(64, 64, 90.0, 0.0, 90.0, 0.0)),
        (panorama(512), perspective(640, 640, 90.0, 0.0, 90.0, 0.0)),
        (panorama(1024), perspective(640, 480, 90.0, 33.0, 20.0, 7.0)),
    ] {
        let memory = Report::of(&world, &target, &FilterSettings::DEFAULT).memory;
        let resampler = Resampler { world: &world, target: &target, filter: FilterSettings::DEFAULT };
        let (plan, fixed) =
            (resampler.plan(Arithmetic::Float).expect("a plan"), resampler.plan(Arithmetic::Fixed).expect("a plan"));
        for (estimate, bytes) in [(memory.plan, plan.bytes()), (memory.fixed_plan, fixed.bytes())] {
            assert_close(estimate as f64 / bytes as f64, 1.0, 0.2);
        }
    }
}

#[test]
fn the_paper_calls_its_own_case_two_to_three() {
    // The limiting circle spans the frame: radius 983 pixels.
    let target = View {
        projection: ProjectionKind::OMNIMAX,
        orientation: Orientation::IDENTITY,
        grid: PixelGrid::centred(1966, 1436, PixelPoint::new(983.0, 983.0), DVec2::splat(1.0 / 983.0)),
        stop: FieldStop::circle(1.0),
    };
    let faces = [CubeFace::Front, CubeFace::Right, CubeFace::Left, CubeFace::Up];
    let report = Report::of(&cube(&faces, 1024, 960), &target, &FilterSettings::DEFAULT);
    let (across, down) = report.views[0].advised.expect("a size").ratio;
    assert_close(across, 0.735, 5e-4);
    assert_close(down, 0.689, 5e-4);
    assert_close((across * down).sqrt(), 2.0 / 3.0, 0.05);
    let fit = OmnimaxFraming::Fit.grid(1966, 1436, 1.0);
    assert!(fit.step().x > target.grid.step().x, "the circle that fits is smaller");
}

#[test]
fn a_report_reads_well() {
    let world = cube(&[CubeFace::Front, CubeFace::Right], 256, 256);
    let report = Report::of(&world, &perspective(320, 240, 80.0, 0.0, 60.0, 0.0), &FilterSettings::DEFAULT);
    let text = report.to_string();
    for part in
        ["target   320x240", "pixels look where no view does", "front  256x256  needs ", "right  256x256  needs "]
    {
        assert!(text.contains(part), "{part} is not in:\n{text}");
    }
}

fn cases() -> Vec<(World, View)> {
    let awkward = World::new([("a <b> & \"c\"\u{7} ü".to_string(), equirect(128))]).expect("a world");
    let tilted = View { orientation: turned([30.0, -50.0, 10.0]), ..fisheye(100, 180.0) };
    vec![
        (cube(&CubeFace::ALL, 128, 128), omnimax(246, 180)),
        (cube(&[CubeFace::Front, CubeFace::Right, CubeFace::Left, CubeFace::Up], 128, 120), tilted.clone()),
        (cube(&[CubeFace::Front], 64, 64), perspective(80, 60, 60.0, 30.0, 10.0, 5.0)),
        (cube(&CubeFace::ALL, 64, 64), equirect(96)),
        (awkward, tilted),
    ]
}

fn figures_of(world: &World, target: &View) -> [String; 3] {
    let needs = Needs::of(world, std::slice::from_ref(target), &FilterSettings::DEFAULT, Accuracy::Exact);
    let figures = Figures { world, target };
    let underlay = Underlay { view: 0, href: "a.png?b=\"1\"&c".to_string() };
    [figures.unfolded(&needs, &[underlay]), figures.ownership(), figures.footprints()]
}

#[test]
fn figures_are_well_formed() {
    for (world, target) in cases() {
        for svg in figures_of(&world, &target) {
            let document = roxmltree::Document::parse(&svg).expect("well-formed XML");
            assert_eq!(document.root_element().tag_name().name(), "svg");
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "a number is missing");
        }
    }
}

#[test]
fn figures_and_needs_do_not_depend_on_threads() {
    let with_threads = |threads: usize, (world, target): &(World, View)| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let report = Report::of(world, target, &FilterSettings::DEFAULT);
            (figures_of(world, target), report.to_string(), report)
        })
    };
    for case in cases() {
        let one = with_threads(1, &case);
        for threads in [2, 7] {
            let (figures, text, report) = with_threads(threads, &case);
            assert_eq!((&text, &report), (&one.1, &one.2));
            assert!(figures == one.0);
        }
    }
}

#[test]
fn the_unfolded_cube_names_what_is_needed_and_what_is_not_given() {
    let faces = [CubeFace::Front, CubeFace::Right, CubeFace::Back, CubeFace::Left, CubeFace::Up];
    let (world, target) = (cube(&faces, 1024, 1024), omnimax(1966, 1436));
    let needs = Needs::of(&world, std::slice::from_ref(&target), &FilterSettings::DEFAULT, Accuracy::Exact);
    let svg = Figures { world: &world, target: &target }.unfolded(&needs, &[]);
    for label in ["all of 1024×1024", "515×1024+509+0", "515×1024+0+0", "1024×515+0+509", "not needed", "not given"]
    {
        assert!(svg.contains(&format!("aria-label=\"{label}\"")), "{label}");
    }
}

#[test]
fn an_underlay_is_drawn_under_the_veil() {
    let (world, target) = (cube(&CubeFace::ALL, 64, 64), omnimax(123, 90));
    let needs = Needs::of(&world, std::slice::from_ref(&target), &FilterSettings::DEFAULT, Accuracy::Exact);
    let underlay = Underlay { view: 4, href: "data:image/png;base64,AA==".to_string() };
    let svg = Figures { world: &world, target: &target }.unfolded(&needs, &[underlay]);
    let image = svg.find("href=\"data:image/png;base64,AA==\"").expect("the image");
    assert!(svg[image..].contains("opacity=\"0.74\""));
}
