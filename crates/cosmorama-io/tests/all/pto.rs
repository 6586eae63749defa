//! Hugin projects: what Hugin writes is read, what is not supported is named with its line.

use cosmorama_io::PtoProject;

/// As Hugin 2022 writes it, control points left out.
const PROJECT: &str = "# hugin project file\n#hugin_ptoversion 2\np f2 w3000 h1500 v360  k0 E12.5 R0 S100,2900,200,1300 n\"TIFF_m c:LZW r:CROP\"\n\
m i0\n\n# image lines\n#-hugin  cropFactor=1.5\ni w400 h300 f0 v50 Ra0 Rb0 Rc0 Rd0 Re0 Eev12.5 Er1 Eb1 r0.5 p-3 y10 TrX0 TrY0 TrZ0 \
Tpy0 Tpp0 j0 a0.01 b-0.02 c0.003 d4 e-5 g0 t0 Va1 Vb0 Vc0 Vd0 Vx0 Vy0  Vm5 n\"first image.png\"\ni w400 h300 f0 v=0 Ra=0 Rb=0 \
Rc=0 Rd=0 Re=0 Eev12.5 Er1 Eb1 r0 p0 y-20 TrX0 TrY0 TrZ0 Tpy0 Tpp0 j0 a=0 b=0 c=0 d=0 e=0 g=0 t=0 Va=0 Vb=0 Vc=0 Vd=0 Vx=0 Vy=0  \
Vm5 S10,390,20,280 n\"second.png\"\n\n# variable lines\nv y1\nv\n\n# control points\nc n0 N1 x1 y2 X3 Y4 t0\n";

fn read(text: &str) -> Result<PtoProject, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("project.pto");
    std::fs::write(&path, text).unwrap();
    PtoProject::read(&path).map_err(|error| error.to_string())
}

#[test]
fn what_hugin_writes_is_read() {
    let project = read(PROJECT).unwrap();
    let panorama = project.panorama.unwrap();
    assert_eq!((panorama.projection, panorama.size, panorama.field_of_view), (2, (3000, 1500), 360.0));
    assert_eq!(panorama.crop, Some([100, 2900, 200, 1300]));
    let [first, second] = &project.images[..] else { panic!("two images") };
    assert_eq!((first.file.to_str(), first.size, first.lens), (Some("first image.png"), (400, 300), 0));
    assert_eq!((first.yaw_pitch_roll, first.crop), ([10.0, -3.0, 0.5], None));
    assert_eq!((second.field_of_view, second.correction, second.shift), (50.0, [0.01, -0.02, 0.003], [4.0, -5.0]));
    assert_eq!((second.yaw_pitch_roll, second.crop), ([-20.0, 0.0, 0.0], Some([10, 390, 20, 280])));
    let masked = read(&PROJECT.replace("v y1", "k i1 t0 p\"1 2.5 3 4 5 6\"")).unwrap();
    assert_eq!(masked.images[1].holes, [vec![[1.0, 2.5], [3.0, 4.0], [5.0, 6.0]]]);
    assert_eq!(project.warnings.len(), 1, "{:?}", project.warnings);
    assert!(read(&(PROJECT.to_owned() + "\n*\n# the end\n")).is_ok());
}

#[test]
fn what_is_not_supported_is_named_with_its_line() {
    for (from, to, expected) in [
        ("g0 t0", "g0.1 t0", &["line 8", "g: shear"][..]),
        ("TrX0 TrY0 TrZ0 Tpy0 Tpp0 j0 a0.01", "TrX0 TrY2 TrZ0 Tpy0 Tpp0 j0 a0.01", &["line 8", "TrY: translation"]),
        ("Va1 Vb0", "Va1 Vb-0.3", &["line 8", "Vb: vignetting"]),
        ("Eev12.5 Er1 Eb1 r0 p0", "Eev13 Er1 Eb1 r0 p0", &["line 9", "Eev13", "Eev12.5"]),
        ("v=0", "v=7", &["line 9", "v=7", "from 0 to 1"]),
        ("v=0", "v=1", &["line 9", "v=1"]),
        ("v=0", "vx", &["line 9", "vx", "a number"]),
        ("v50", "v1e999", &["line 8", "v1e999"]),
        ("w400 h300 f0 v50", "w-4 h300 f0 v50", &["line 8", "w-4", "pixels"]),
        ("f0 v50", "f0.5 v50", &["line 8", "f0.5"]),
        ("S10,390,20,280", "S390,10,20,280", &["line 9", "LEFT,RIGHT"]),
        ("S10,390,20,280", "S-9223372036854775808,60,0,60", &["line 9", "LEFT,RIGHT"]),
        ("j0 a0.01", "q3 a0.01", &["line 8", "'q3'"]),
        ("n\"second.png\"", "n\"second.png", &["line 9", "does not end"]),
        ("n\"second.png\"", "", &["line 9", "n, the picture's file"]),
        ("v y1", "k i0 t1 p\"1 1 2 2 3 1\"", &["line 12", "t1"]),
        ("v y1", "k i5 t0 p\"1 1 2 2 3 1\"", &["line 12", "i5"]),
        ("v y1", "k i0 t0 p\"1 1 2 2 3\"", &["line 12", "corners"]),
        ("v y1", "k i0 t0 p\"1 1 2 2 3 x\"", &["line 12", "'x'"]),
        ("f2 w3000", "f2 f3 w3000", &["line 3", "twice"]),
        ("v y1", "x y1", &["line 12", "'x' begins no line"]),
    ] {
        assert!(PROJECT.contains(from), "{from}");
        let error = read(&PROJECT.replacen(from, to, 1)).unwrap_err();
        for part in expected {
            assert!(error.contains(part) && error.contains("project.pto"), "{part}: {error}");
        }
    }
    assert!(read("# nothing\n").unwrap_err().contains("no i-line"));
}
