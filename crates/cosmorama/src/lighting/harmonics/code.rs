use super::basis::HarmonicFunctions;
use super::stored::StoredHarmonics;

/// Language in which harmonics can be written as a program's source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CodeLanguage {
    /// OpenGL's shading language, 3.00 ES or 3.30 on.
    Glsl,
    /// DirectX's shading language.
    Hlsl,
    /// Rust, without crates.
    Rust,
    /// C++17, a header.
    Cpp,
}

impl StoredHarmonics {
    /// Writes the numbers, and a function that takes them back to light: `world_light`, of a unit vector in the axes of the numbers.
    pub fn code(&self, language: CodeLanguage) -> String {
        let Parts { steps, functions } = Parts::of(self, language);
        let count = functions.len();
        let lines = |lines: Vec<String>| lines.concat();
        let numbers = |open: &str, close: &str| {
            let number = |[red, green, blue]: &[f64; 3]| {
                let [red, green, blue] = [red, green, blue].map(|light| literal(*light, language));
                format!("    {open}{red}, {green}, {blue}{close},\n")
            };
            let all = lines(self.numbers().iter().map(number).collect());
            // Shading languages take no comma behind the last.
            all.trim_end().trim_end_matches(',').to_owned() + "\n"
        };
        let declared =
            |word: &str| lines(steps.iter().map(|(name, value)| format!("    {word} {name} = {value};\n")).collect());
        let listed = || lines(functions.iter().map(|function| format!("        {function},\n")).collect());
        let summed = |vector: &str| {
            let term = |(k, function): (usize, &String)| format!("    light += WORLD_LIGHT[{k}] * ({function});\n");
            let sum = lines(functions.iter().enumerate().map(term).collect());
            format!("    {vector} light = {vector}(0.0, 0.0, 0.0);\n{sum}    return light;\n}}\n")
        };
        let head = self.head();
        match language {
            CodeLanguage::Glsl => format!(
                "{head}const vec3 WORLD_LIGHT[{count}] = vec3[{count}](\n{});\n\nvec3 world_light(vec3 direction) {{\n{SHADER_AXES}{}{}",
                numbers("vec3(", ")"),
                declared("float"),
                summed("vec3"),
            ),
            CodeLanguage::Hlsl => format!(
                "{head}static const float3 WORLD_LIGHT[{count}] = {{\n{}}};\n\nfloat3 world_light(float3 direction) {{\n{SHADER_AXES}{}{}",
                numbers("float3(", ")"),
                declared("float"),
                summed("float3"),
            ),
            CodeLanguage::Rust => format!(
                "{head}pub const WORLD_LIGHT: [[f32; 3]; {count}] = [\n{}];\n\n#[allow(unused_variables)]\n\
                 pub fn world_light([x, y, z]: [f32; 3]) -> [f32; 3] {{\n{}    let functions: [f32; {count}] = [\n{}    ];\n{RUST_SUM}",
                numbers("[", "]"),
                declared("let"),
                listed(),
            ),
            CodeLanguage::Cpp => format!(
                "{head}#pragma once\n\n#include <array>\n\ninline constexpr float WORLD_LIGHT[{count}][3] = {{\n{}}};\n\n\
                 inline std::array<float, 3> world_light([[maybe_unused]] float x, [[maybe_unused]] float y, [[maybe_unused]] float z) {{\n\
                 {}    const float functions[{count}] = {{\n{}    }};\n{}",
                numbers("{", "}"),
                declared("const float"),
                listed(),
                CPP_SUM.replace("COUNT", &count.to_string()),
            ),
        }
    }

    /// Returns the comment on top.
    fn head(&self) -> String {
        let [x, y, z] = self.basis().sides();
        format!(
            "// Spherical harmonics of a world's light up to order {}, by cosmorama.\n\
             // world_light returns the {} of red, green and blue, in a direction of length 1:\n\
             // +x is {x}, +y {y}, +z {z}; the front is the middle of a panorama.\n\n",
            self.order(),
            self.sum().replace('π', "pi"),
        )
    }
}

const SHADER_AXES: &str = "    float x = direction.x;\n    float y = direction.y;\n    float z = direction.z;\n";

const RUST_SUM: &str = "    let mut light = [0.0; 3];
    for (function, numbers) in functions.iter().zip(&WORLD_LIGHT) {
        for (light, number) in light.iter_mut().zip(numbers) {
            *light += function * number;
        }
    }
    light
}
";

const CPP_SUM: &str = "    std::array<float, 3> light{};
    for (int k = 0; k < COUNT; ++k) {
        for (int channel = 0; channel < 3; ++channel) {
            light[channel] += functions[k] * WORLD_LIGHT[k][channel];
        }
    }
    return light;
}
";

/// Formulas of the functions, in x, y and z, the same in all languages.
struct Parts {
    /// Names and values of what functions share.
    steps: Vec<(String, String)>,
    functions: Vec<String>,
}

impl Parts {
    fn of(stored: &StoredHarmonics, language: CodeLanguage) -> Self {
        let mut steps = Vec::new();
        for m in 2..=stored.order() {
            let (cos, sin) = around(m - 1);
            steps.push((format!("c{m}"), format!("x * {cos} - y * {sin}")));
            steps.push((format!("s{m}"), format!("x * {sin} + y * {cos}")));
        }
        let mut functions = vec![String::new(); stored.weights().len()];
        let harmonics = HarmonicFunctions::new(stored.order(), stored.basis());
        for (l, m, leading, share) in harmonics.polynomials() {
            // Polynomials in z, with a factor of 1 at the highest power.
            if l >= m + 2 {
                let share = literal(share, language);
                let less = if l == m + 2 { share } else { format!("{share} * {}", polynomial(l - 2, m)) };
                steps.push((polynomial(l, m), format!("z * {} - {less}", polynomial(l - 1, m))));
            }
            let mut function = |k: usize, side: Option<String>| {
                let factor = leading * stored.weights()[k];
                let factor = ((factor - 1.0).abs() > 1e-12).then(|| literal(factor, language));
                let height = (l > m).then(|| polynomial(l, m));
                let product: Vec<String> = [factor, height, side].into_iter().flatten().collect();
                functions[k] = if product.is_empty() { literal(1.0, language) } else { product.join(" * ") };
            };
            let middle = l * l + l;
            if m == 0 {
                function(middle, None);
            } else {
                let (cos, sin) = around(m);
                function(middle + m, Some(cos));
                function(middle - m, Some(sin));
            }
        }
        Self { steps, functions }
    }
}

/// Names Re (x + iy)^m and Im (x + iy)^m.
fn around(m: usize) -> (String, String) {
    if m == 1 { ("x".to_owned(), "y".to_owned()) } else { (format!("c{m}"), format!("s{m}")) }
}

/// Names the polynomial in z of a band and a number.
fn polynomial(l: usize, m: usize) -> String {
    if l == m + 1 { "z".to_owned() } else { format!("p{l}_{m}") }
}

/// Returns the shortest number that a float reads alike, with a point or an exponent.
fn literal(number: f64, language: CodeLanguage) -> String {
    let suffix = if language == CodeLanguage::Cpp { "f" } else { "" };
    format!("{:?}{suffix}", number as f32)
}
