/// Weights of red and blue in luma; green has the rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matrix {
    /// Weight of red.
    pub red: f64,
    /// Weight of blue.
    pub blue: f64,
}
