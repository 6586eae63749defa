//! Models from files.

use std::path::PathBuf;

use cosmorama::camera::PixelPoint;
use cosmorama::filter::{FilterSettings, Texture, Wrap};
use cosmorama::raster::{Channels, Depth, EncodedImage, Image, Rgba, Transfer};
use cosmorama::world::World;
use cosmorama_scene::{
    Background, Camera, Finish, LightMaps, Material, Model, ModelSettings, Orthographic, PictureKind, PictureReader,
    PictureSource, Place, Scene, Shape, Sky, Surroundings, picture,
};

pub(crate) const SETTINGS: ModelSettings =
    ModelSettings { crease: None, material: None, most: 1_000_000, placing: None };

/// Reads pictures as the program does.
pub(crate) struct Files;

impl PictureReader for Files {
    fn picture(&mut self, source: PictureSource, kind: PictureKind) -> Result<Image<Rgba>, String> {
        let limits = cosmorama_io::Limits::default();
        let file = match source {
            PictureSource::File(path) => cosmorama_io::read(path, &limits),
            PictureSource::Bytes(bytes) => cosmorama_io::read_from(std::io::Cursor::new(bytes), "inside", &limits),
        };
        let file = file.map_err(|error| error.to_string())?;
        let transfer = if kind == PictureKind::Colour { file.transfer() } else { Transfer::Linear };
        Ok(file.image.without_alpha().to_light(&transfer))
    }
}

/// A file that is removed after the test.
pub(crate) struct File(pub(crate) PathBuf);

impl File {
    pub(crate) fn new(name: &str, text: &str) -> Self {
        Self::write(name, text.as_bytes())
    }

    pub(crate) fn write(name: &str, bytes: &[u8]) -> Self {
        let path = std::env::temp_dir().join(format!("cosmorama-{}-{name}", std::process::id()));
        std::fs::write(&path, bytes).unwrap();
        Self(path)
    }

    pub(crate) fn read(&self) -> Result<Model, String> {
        Model::read(&self.0, &SETTINGS, &mut Files).map_err(|error| error.to_string())
    }
}

impl Drop for File {
    fn drop(&mut self) {
        std::fs::remove_file(&self.0).unwrap();
    }
}

const SQUARE: &str =
    "# a square, in all forms of corners\nv 0 0 0\nv 1 0 0\nv 1 1 0 1.0\nv 0 1 0\nvt 0 0\nvt 1 1 0\nvn 0 0 1\n";

#[test]
fn obj_files_are_read() {
    let text = format!(
        "{SQUARE}g left\nusemtl red\nf 1 2 3\nusemtl blue\nf 1/1 3/2 4/1\ng right\nf -4//1 -3//-1 -2//1\nf 1/1/1 2/1/1 3/2/1 4/2/1\n"
    );
    let file = File::new("square.obj", &text);
    let model = file.read().unwrap();
    let names: Vec<&str> = model.object.parts.iter().map(|part| part.name.as_str()).collect();
    assert_eq!(names, ["red", "blue", "right"]);
    let Shape::Mesh(mesh) = &model.object.shape else { panic!() };
    assert_eq!(mesh.count(), 5);
    assert_eq!(mesh.ball().centre.to_array(), [0.5, 0.5, 0.0]);
    let material = Some(Material::MATTE);
    let matt = Model::read(&file.0, &ModelSettings { material, ..SETTINGS }, &mut Files).unwrap();
    assert!(matt.object.parts.iter().all(|part| part.material == Material::MATTE));
}

#[test]
fn faults_of_obj_files_name_the_line() {
    let cases = [
        ("f 1 2 7", "line 9: vertex '7' is not there: 4 are"),
        ("f 1 2 0", "line 9: vertex '0'"),
        ("f 1 2 -5", "line 9: vertex '-5'"),
        ("f 1/9 2/1 3/1", "line 9: texture coordinates '9'"),
        ("f 1//2 2//1 3//1", "line 9: normal '2'"),
        ("f 1 2", "line 9: the face has 2 corners"),
        ("f a b c", "line 9: vertex 'a' is not a whole number"),
        ("v 1 2", "line 9: expected 3 numbers"),
        ("v 1 2 x", "line 9: expected a number, but found 'x'"),
        ("v nan 0 0\nf 1 2 5", "line 9: expected a number, but found 'nan'"),
        ("vn 0 inf 0", "line 9: expected a number, but found 'inf'"),
        ("vt 0 1e999", "line 9: expected a number, but found '1e999'"),
        ("v 1e80 0 0\nf 1 2 5", "corner 2 of triangle 0 is not a point"),
        ("", "no triangle"),
    ];
    for (line, says) in cases {
        let error = File::new("wrong.obj", &format!("{SQUARE}{line}\n")).read().unwrap_err();
        assert!(error.contains(says) && error.contains("wrong.obj"), "{line}: {error}");
    }
    let error = Model::read("nothing.obj".as_ref(), &SETTINGS, &mut Files).unwrap_err().to_string();
    assert!(error.contains("nothing.obj"), "{error}");
    let error = Model::read("nothing.stl".as_ref(), &SETTINGS, &mut Files).unwrap_err().to_string();
    assert!(error.contains(".obj"), "{error}");
}

/// Part of a thing's shadow along z that is at a place of the plane z = 0.
fn is_covered(model: &Model, x: f64, y: f64) -> bool {
    let place = Place { eye: [x, y, 5.0].into(), target: [x, y, 0.0].into() };
    let camera = Camera::Orthographic(Orthographic::new(place, 0.01, [1, 1]).unwrap());
    let (world, light) = World::from_panorama(Image::filled(4, 2, Rgba::opaque(1.0, 1.0, 1.0))).unwrap();
    let scene = Scene { objects: vec![model.object.clone()] };
    let sky = Sky::new(&world, &light);
    let maps = LightMaps::of(&scene, 0, sky).unwrap();
    let surroundings = Surroundings::new(sky, &maps, FilterSettings::DEFAULT).unwrap();
    let image = picture(&scene, &camera, &[surroundings], Background::Colour(Rgba::TRANSPARENT)).unwrap();
    image.get(0, 0).alpha() > 0.5
}

#[test]
fn polygons_that_bend_inward_are_what_they_look_like() {
    const L: &str = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n";
    // A fan from the second corner would cover what the L leaves free.
    for corners in ["1 2 3 4 5 6", "2 3 4 5 6 1", "6 5 4 3 2 1"] {
        let model = File::new("l.obj", &format!("{L}f {corners}\n")).read().unwrap();
        assert!(model.notes.is_empty(), "{:?}", model.notes);
        for (x, y, is_there) in
            [(0.5, 0.5, true), (1.7, 0.8, true), (0.8, 1.7, true), (1.3, 1.3, false), (1.7, 1.7, false)]
        {
            assert_eq!(is_covered(&model, x, y), is_there, "{corners}: {x}, {y}");
        }
    }
    let crossed = File::new("bow.obj", &format!("{L}f 1 3 2 6 4\n")).read().unwrap();
    assert!(crossed.notes.join(" ").contains("1 faces cross themselves"), "{:?}", crossed.notes);
}

#[test]
fn numbers_of_gltf_that_are_none_are_named() {
    let bytes: Vec<u8> =
        [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, f32::NAN, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]]
            .iter()
            .flatten()
            .flat_map(|number| number.to_le_bytes())
            .collect();
    let text = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "NORMAL": 1}}}}]}}],
        "buffers": [{{"byteLength": 72, "uri": "data:;base64,{}"}}], "bufferViews": [{{"buffer": 0, "byteLength": 72}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}},
        {{"bufferView": 0, "byteOffset": 36, "componentType": 5126, "count": 3, "type": "VEC3"}}]}}"#,
        base64(&bytes)
    );
    let error = File::new("normals.gltf", &text).read().unwrap_err();
    assert!(error.contains("normals.gltf: accessor 1 has normals of vertex 0 that are no numbers"), "{error}");
}

#[test]
fn more_triangles_than_fit_are_refused_before_they_are_made() {
    let file = File::new("large.obj", &format!("{SQUARE}{}", "f 1 2 3 4\n".repeat(600_000)));
    let error = file.read().unwrap_err();
    assert!(error.contains("1200000 triangles"), "{error}");
}

#[test]
fn files_longer_than_memory_are_refused_before_they_are_read() {
    let few = ModelSettings { most: 10, ..SETTINGS };
    let long = File::new("long.obj", &format!("{SQUARE}f 1 2 3\n#{}\n", "-".repeat(20_000)));
    let points = File::new("points.obj", &format!("{SQUARE}{}f 1 2 3\n", "v 0 0 0\n".repeat(100)));
    let json =
        Gltf::new("json", &SQUARES.replacen(r#""asset""#, &format!(r#""extras": "{}", "asset""#, "-".repeat(600)), 1));
    for (path, says) in [(&long.0, "memory for 15000"), (&points.0, "memory for 10"), (&json.file.0, "memory for 468")]
    {
        let error = Model::read(path, &few, &mut Files).unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
}

#[test]
fn lines_that_are_not_read_are_told() {
    let text = format!("{SQUARE}v 0 0 1 0.5 0.5 0.5\ns 1\nl 1 2\n#comment\ncstype bezier\nf 1 2 3\n");
    let notes = File::new("lines.obj", &text).read().unwrap().notes.join("; ");
    assert!(notes.contains("not read: cstype, l, s, colours of vertices"), "{notes}");
    let smooth = File::new("smooth.obj", &format!("{SQUARE}s 1\nf 1//1 2//1 3//1\n")).read().unwrap();
    assert!(smooth.notes.is_empty(), "{:?}", smooth.notes);
}

/// Four corners of a square of side 1, as numbers of a buffer, and the indices of a strip.
fn square_bytes() -> Vec<u8> {
    let corners = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    let numbers = corners.iter().flatten().flat_map(|number| number.to_le_bytes());
    numbers.chain([0u8, 1, 2, 3]).collect()
}

/// A glTF of two squares, the second mirrored and under a node that moves it, and of a camera.
const SQUARES: &str = r#"{
  "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 3]}],
  "nodes": [
    {"name": "one", "mesh": 0},
    {"translation": [5, 0, 0], "children": [2]},
    {"name": "two", "mesh": 0, "scale": [-2, 1, 1]},
    {"name": "eye", "camera": 0, "translation": [0.5, 0.5, 9]}
  ],
  "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1, "aspectRatio": 2}}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": 5}]}],
  "accessors": [
    {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
    {"bufferView": 1, "componentType": 5121, "count": 4, "type": "SCALAR"}
  ],
  "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 4}],
  "buffers": [{"uri": "NAME%2Ebin", "byteLength": 52}]
}"#;

/// A glTF and its buffer, beside it.
struct Gltf {
    file: File,
    _buffer: File,
}

impl Gltf {
    fn new(name: &str, text: &str) -> Self {
        let buffer = File::write(&format!("{name}.bin"), &square_bytes());
        let uri = buffer.0.file_name().unwrap().to_string_lossy().trim_end_matches(".bin").to_owned();
        Self { file: File::new(&format!("{name}.gltf"), &text.replace("NAME", &uri)), _buffer: buffer }
    }
}

#[test]
fn gltf_files_are_read_with_their_nodes_and_cameras() {
    let gltf = Gltf::new("squares", SQUARES);
    let model = gltf.file.read().unwrap();
    let names: Vec<&str> = model.object.parts.iter().map(|part| part.name.as_str()).collect();
    assert_eq!(names, ["one", "two"]);
    let Shape::Mesh(mesh) = &model.object.shape else { panic!() };
    assert_eq!((mesh.count(), mesh.skipped()), (4, 0));
    // From 0 to 1, and from 3 to 5.
    assert_eq!(mesh.ball().centre.to_array(), [2.5, 0.5, 0.0]);
    assert!(mesh.hole().is_some());
    let [camera] = model.cameras.as_slice() else { panic!("{:?}", model.cameras) };
    assert_eq!((camera.name.as_str(), camera.rows(640)), ("eye", 320));
    let ray = camera.camera([640, 320]).unwrap().ray(PixelPoint::new(320.0, 0.0)).unwrap();
    assert_eq!(ray.origin.to_array(), [0.5, 0.5, 9.0]);
    assert!((ray.direction.y - 0.25f64.sin()).abs() < 1e-6 && ray.direction.z < 0.0, "{:?}", ray.direction);
}

#[test]
fn faults_of_gltf_files_are_named() {
    let cases = [
        (
            r#""asset""#,
            r#""extensionsRequired": ["KHR_draco_mesh_compression"], "asset""#,
            "KHR_draco_mesh_compression",
        ),
        (r#""scale": [-2, 1, 1]"#, r#""children": [1]"#, "node 1 is below itself"),
        (r#"[0, 1, 3]"#, r#"[0, 1, 2]"#, "node 2 is below itself, or has two parents"),
        (r#"[0, 1, 3]"#, r#"[0, 1, 7]"#, "nodes"),
        ("NAME%2Ebin", "nothing.bin", "buffer 0 cannot be read"),
        ("NAME%2Ebin", "https://example.org/x.bin", "buffer 0 is at 'https"),
        ("NAME%2Ebin", "data:;base64,AAAA", "buffer 0 has 3 bytes; expected 52"),
        (r#""componentType": 5121, "count": 4"#, r#""componentType": 5123, "count": 2"#, "accessor 1 names vertex 256"),
        (r#""componentType": 5121, "count": 4"#, r#""componentType": 5121, "count": 5"#, "accessor 1 has 5 elements"),
        (r#""byteOffset": 48"#, r#""byteOffset": 49"#, "view 1"),
        (r#""count": 4, "type": "SCALAR""#, r#""count": 4000000000, "type": "SCALAR""#, "7999999996 triangles"),
        (r#""count": 4, "type": "VEC3""#, r#""count": 4000000000, "type": "VEC3""#, "triangles"),
        (r#""type": "SCALAR""#, r#""type": "VEC2""#, "accessor 1 has elements of 2 numbers"),
        (r#""scene": 0, "scenes": [{"nodes": [0, 1, 3]}],"#, "", "no scene"),
        (r#""mode": 5"#, r#""mode": 0"#, "no triangle"),
        ("{", "", "line 2"),
        (r#""POSITION": 0"#, r#""POSITION": 9"#, "accessor that is not there"),
        (
            r#""perspective": {"#,
            r#""orthographic": {"xmag": 1, "ymag": 1, "zfar": 2, "#,
            "camera 0 does not have the numbers",
        ),
        (r#""byteLength": 52"#, r#""byteLength": 9000000000000"#, "memory allows"),
        ("NAME%2Ebin", "/dev/stdin", "buffer 0 is at '/dev/stdin'"),
        ("NAME%2Ebin", ".", "which is no file"),
        (r#""version": "2.0""#, r#""version": "1.0""#, "it is of glTF 1.0; expected 2.0"),
        (r#""version": "2.0""#, r#""version": "2.9", "minVersion": "2.9""#, "it is of glTF 2.9"),
    ];
    for (k, (from, to, says)) in cases.into_iter().enumerate() {
        let error = Gltf::new(&format!("fault{k}"), &SQUARES.replacen(from, to, 1)).file.read().unwrap_err();
        assert!(error.contains(says) && error.contains(".gltf"), "{to}: {error}");
    }
    let short = [&b"glTF"[..], &2u32.to_le_bytes(), &0u32.to_le_bytes()].concat();
    for (bytes, says) in [(&[][..], "empty.glb"), (&short[..6], "empty.glb"), (&short, "says that it has 0 bytes")] {
        let error = File::write("empty.glb", bytes).read().unwrap_err();
        assert!(error.contains(says), "{error}");
    }
}

/// Returns what a part is made of.
fn finish(model: &Model, part: usize) -> &Finish {
    model.object.parts[part].material.finish.as_ref().expect("metallic-roughness")
}

#[test]
fn materials_of_obj_are_read_by_their_numbers() {
    let library = "\u{b}\n\u{3000}\n# a library\nnewmtl red\nKd 0.7 0.1 0.1\nKs 0.02\nNs 98\nKe 0 0 2\nillum 2\nd 1.0\n\
                   newmtl steel\nKd 0.1 0.1 0.1\nKs 0.6 0.55 0.5\nmap_Ks none.png\nmap_Ns none.png\nd 0.5\nnewmtl plain\nKd spectral x.rfl\n";
    let library = File::new("colours.mtl", library);
    let name = library.0.file_name().unwrap().to_string_lossy();
    let text = format!(
        "\u{b}\n\u{3000}\n{SQUARE}vt 0.5\nmtllib {name}\nusemtl red\nf 1 2 3\nusemtl steel\nf 1 3 4\nusemtl plain\nf 1 2 4\n\
         usemtl gone\nf 2 3 4\n"
    );
    let file = File::new("colours.obj", &text);
    let model = file.read().unwrap();
    let red = finish(&model, 0);
    assert_eq!((red.base.colour, red.emissive.colour, red.metallic), ([0.7, 0.1, 0.1], [0.0, 0.0, 2.0], 0.0));
    // α = √(2/(98 + 2)), of which roughness is the root; half of an insulator's 0.04.
    assert!((red.roughness.powi(4) - 0.02).abs() < 1e-12 && (red.specular - 0.5).abs() < 1e-12, "{red:?}");
    let steel = finish(&model, 1);
    assert_eq!((steel.base.colour, steel.metallic), ([0.6, 0.55, 0.5], 1.0));
    assert_eq!(finish(&model, 2).base.colour, [0.8; 3]);
    assert_eq!(model.object.parts[3].material, Material::MIRROR);
    let notes = model.notes.join("; ");
    assert!(notes.contains("not read: Kd, d, map_Ks, map_Ns") && notes.contains("material gone"), "{notes}");
    // Where another material is given, libraries do not count.
    let material = Some(Material::MATTE);
    let matt = Model::read(&file.0, &ModelSettings { material, ..SETTINGS }, &mut Files).unwrap();
    assert!(matt.notes.is_empty(), "{:?}", matt.notes);
    let wrong = File::new("wrong.mtl", "newmtl x\nKd -1 0 0\n");
    let name = wrong.0.file_name().unwrap().to_string_lossy();
    let error = File::new("dark.obj", &format!("{SQUARE}mtllib {name}\nusemtl x\nf 1 2 3\n")).read().unwrap_err();
    assert!(error.contains("material of x is out of range"), "{error}");
}

#[test]
fn materials_of_gltf_are_read_by_their_numbers() {
    let text = SQUARES.replacen(r#""mode": 5"#, r#""mode": 5, "material": 0"#, 1).replacen(
        r#""asset""#,
        r#""extensionsUsed": ["KHR_materials_unlit"], "materials": [{"emissiveFactor": [0.25, 0, 0.5], "pbrMetallicRoughness":
           {"baseColorFactor": [0.5, 0.25, 1, 1], "metallicFactor": 0.5, "roughnessFactor": 0.75}}], "asset""#,
        1,
    );
    let model = Gltf::new("paint", &text).file.read().unwrap();
    let found = finish(&model, 0);
    assert_eq!((found.base.colour, found.emissive.colour), ([0.5, 0.25, 1.0], [0.25, 0.0, 0.5]));
    assert_eq!((found.metallic, found.roughness), (0.5, 0.75));
    assert!(model.notes.join("; ").contains("KHR_materials_unlit is not applied"), "{:?}", model.notes);
}

/// A picture of two texels, red on the left and green on the right, or grey in both, as PNG.
pub(crate) fn two_texels(name: &str, is_grey: bool) -> File {
    let colour =
        |i: usize| if is_grey { Rgba::opaque(0.5, 0.5, 0.5) } else { Rgba::opaque(1.0 - i as f32, i as f32, 0.0) };
    let picture = Image::from_fn(2, 1, |i, _| colour(i));
    let encoded = EncodedImage::encode(&picture, Channels::Rgb, Depth::Eight, &Transfer::Srgb);
    let path = std::env::temp_dir().join(format!("cosmorama-{}-{name}", std::process::id()));
    cosmorama_io::write(&path, &encoded, &cosmorama_io::WriteOptions::default()).unwrap();
    File(path)
}

/// The name of a file without its folder.
pub(crate) fn name_of(file: &File) -> String {
    file.0.file_name().unwrap().to_string_lossy().into_owned()
}

fn found_material(model: &Model, part: usize) -> Material {
    model.object.parts[part].material.clone()
}

fn first_texel(map: &Option<std::sync::Arc<Texture>>) -> [f32; 4] {
    map.as_ref().expect("a picture").picture().get(0, 0).0
}

#[test]
fn pictures_of_obj_materials_are_read() {
    let (colours, bumps) = (two_texels("two texels.png", false), two_texels("grey.png", true));
    let library = format!(
        "newmtl a\nKd 0.5 0.5 0.5\nmap_Kd -clamp on {}\nmap_Bump -bm 0.25 {}\nnewmtl b\nKe 0 0 0\nmap_Ke -s 2 2 {}\nmap_Kd gone.png\n",
        name_of(&colours),
        name_of(&bumps),
        name_of(&colours)
    );
    let library = File::new("pictures.mtl", &library);
    let text = format!("{SQUARE}mtllib {}\nusemtl a\nf 1/1 2/2 3/1\n", name_of(&library));
    let file = File::new("pictures.obj", &text);
    let model = file.read().unwrap();
    let found = finish(&model, 0);
    assert_eq!((found.base.colour, first_texel(&found.base.map)), ([0.5; 3], [1.0, 0.0, 0.0, 1.0]));
    assert_eq!(found.base.map.as_ref().map(|map| map.wrap()), Some([Wrap::Clamp; 2]));
    assert_eq!(found.normal_map.as_ref().map(|map| map.scale), Some(0.25));
    let notes = model.notes.join("; ");
    assert!(notes.contains("not read: map_Ke"), "scales of pictures are told: {notes}");
    // A face without texture coordinates shows no picture.
    let bare = File::new("bare.obj", &format!("{text}f 1 2 3\n")).read().unwrap();
    assert!(bare.notes.join("; ").contains("pictures are not shown on all of: a"), "{:?}", bare.notes);
    let plain = File::new("plain.obj", &format!("{SQUARE}f 1 2 3\n"));
    let material = Some(found_material(&model, 0));
    let error = Model::read(&plain.0, &ModelSettings { material, ..SETTINGS }, &mut Files).unwrap_err().to_string();
    assert!(error.contains("no texture coordinates"), "{error}");
    // Nobody asks for the pictures of materials that no part has.
    let error = File::new("lost.obj", &format!("{text}usemtl b\nf 1 2 3\n")).read().unwrap_err();
    assert!(error.contains("line 13: material b: ") && error.contains("gone.png"), "{error}");
}

#[test]
fn pictures_of_gltf_materials_are_read() {
    let picture = two_texels("texels.png", false);
    let bytes = std::fs::read(&picture.0).unwrap();
    let inside = format!("data:image/png;base64,{}", base64(&bytes));
    let text = SQUARES.replacen(r#""mode": 5"#, r#""mode": 5, "material": 0"#, 1).replacen(
        r#""asset""#,
        r#""images": [{"uri": "FILE"}, {"uri": "INSIDE"}], "samplers": [{"wrapS": 33071, "wrapT": 33648}],
           "textures": [{"source": 0, "sampler": 0}, {"source": 1}],
           "materials": [{"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 1}, "normalTexture": {"index": 1, "scale": 0.5},
           "occlusionTexture": {"index": 0},
           "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 1}}}], "asset""#,
        1,
    );
    let text = text.replace("FILE", &name_of(&picture)).replace("INSIDE", &inside);
    let model = Gltf::new("pictured", &text).file.read().unwrap();
    let found = finish(&model, 0);
    for map in [&found.base.map, &found.metal_map, &found.emissive.map] {
        assert_eq!(first_texel(map), [1.0, 0.0, 0.0, 1.0]);
    }
    assert_eq!(found.base.map.as_ref().map(|map| map.wrap()), Some([Wrap::Clamp, Wrap::Mirror]));
    assert_eq!(found.normal_map.as_ref().map(|map| map.scale), Some(0.5));
    assert!(model.notes.join("; ").contains("ambient occlusion"), "{:?}", model.notes);
    for (to, says) in [
        ("gone.png", "gone.png"),
        ("data:image/png;base64,AAAA", "image 0 cannot be read"),
        ("https://a.b/c.png", "image 0 is at"),
    ] {
        let error = Gltf::new("lost", &text.replacen(&name_of(&picture), to, 1)).file.read().unwrap_err();
        assert!(error.contains(says) && error.contains("image 0"), "{to}: {error}");
    }
    let bare = text.replacen(&format!(r#"{{"uri": "{}"}}"#, name_of(&picture)), r#"{"bufferView": 0}"#, 1);
    let error = Gltf::new("bare", &bare).file.read().unwrap_err();
    assert!(error.contains("image 0 has no picture"), "{error}");
    // Where another material is given, pictures are not asked for.
    let lost = Gltf::new("unasked", &text.replacen(&name_of(&picture), "gone.png", 1));
    let material = Some(Material::MATTE);
    assert!(Model::read(&lost.file.0, &ModelSettings { material, ..SETTINGS }, &mut Files).is_ok());
}

pub(crate) fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let group = |chunk: &[u8]| {
        let bits = (0..3).fold(0, |bits, k| bits << 8 | u32::from(chunk.get(k).copied().unwrap_or(0)));
        let letter =
            |k: usize| if k > chunk.len() { '=' } else { char::from(LETTERS[(bits >> (18 - 6 * k) & 63) as usize]) };
        (0..4).map(letter).collect::<String>()
    };
    bytes.chunks(3).map(group).collect()
}
