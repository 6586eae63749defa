//! World files: views that overlap, blended; mistakes told with their line.

// A test that cannot go on stops where it stands.
#![allow(clippy::unwrap_used)]

mod bench;

use bench::{Bench, assert_says, picture};

const VIEWS: &str = r#"
[[view]]
image = "left.png"
spec = "perspective:fov=90,yaw=-30"
feather = 10

[[view]]
image = "views/right.png"
spec = "perspective:fov=80,yaw=35,pitch=5,roll=10"
feather = 10.0
"#;

/// A panorama, two views of it that overlap, and a world file that has them.
fn bench() -> Bench {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("views")).unwrap();
    bench.save("sky.png", &picture(1, 512, 256));
    let view = ["convert", "sky.png", "--to"];
    bench.succeed(&[&view[..], &["perspective:fov=90", "--yaw", "-30", "--size", "300", "left.png"]].concat());
    let turned = ["--yaw", "35", "--pitch", "5", "--roll", "10", "--size", "200", "views/right.png"];
    bench.succeed(&[&view[..], &["perspective:fov=80"], &turned].concat());
    std::fs::write(bench.path("world.toml"), VIEWS).unwrap();
    std::fs::write(bench.path("hard.toml"), VIEWS.replace("feather = 10", "priority = 1 #")).unwrap();
    bench
}

#[test]
fn overlapping_views_make_one_picture() {
    let bench = bench();
    let to = ["--to", "perspective:fov=60", "--size", "240"];
    bench.succeed(&[&["convert", "sky.png", "direct.png"], &to[..]].concat());
    for world in ["world.toml", "hard.toml"] {
        bench.succeed(&[&["convert", world, "out.png", "-y"], &to[..]].concat());
        bench.succeed(&["compare", "out.png", "direct.png", "--min-psnr", "55"]);
    }
}

#[test]
fn what_no_view_shows_is_told_or_filled() {
    let bench = bench();
    let convert = ["convert", "world.toml", "out.png", "--to", "equirect", "--size", "64"];
    assert_says(&bench.fail(1, &convert), &["look where no view does", "--missing"]);
    bench.succeed(&[&convert[..], &["--missing", "black"]].concat());
}

#[test]
fn mistakes_are_told_with_their_line() {
    let bench = bench();
    for (code, world, expected) in [
        (1, "[[view]]\nimage = \"left.png\"\nspce = \"x\"\n", ["bad.toml, line 3", "`spce`"]),
        (1, "[[view]]\nimage = \"left.png\"\nspec = \"fisheye:fvo=3\"\n", ["bad.toml, line 3", "'fov'"]),
        (1, "[[view]]\n\nimage = \"none.png\"\nspec = \"fisheye\"\n", ["bad.toml, line 3", "none.png"]),
        (1, "[[view]]\nimage = \"left.png\"\nfeather = -2\n", ["bad.toml, line 3", "from 0 to 180"]),
        (1, "[[view]]\nimage = \"world.toml\"\n", ["bad.toml, line 2", "itself"]),
        (1, "[[view]\n", ["bad.toml", "line 1"]),
        (1, "# nothing\n", ["bad.toml", "[[view]]"]),
    ] {
        std::fs::write(bench.path("bad.toml"), world).unwrap();
        assert_says(&bench.fail(code, &["convert", "bad.toml", "out.png", "--to", "equirect"]), &expected);
    }
    let from = ["convert", "world.toml", "out.png", "--from", "cube", "--to", "equirect"];
    assert_says(&bench.fail(2, &from), &["world.toml", "leave out --from"]);
}
