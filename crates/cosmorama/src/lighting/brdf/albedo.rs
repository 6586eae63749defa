/// Light that a surface reflects of a white world, split by Schlick's Fresnel factor F0 + (1 − F0) (1 − v·h)⁵: it is
/// F0 times `scale`, plus `bias` (B. Karis, *Real Shading in Unreal Engine 4*, SIGGRAPH 2013 courses).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Albedo {
    /// Factor of the reflectance along the normal, F0. Cloth has no Fresnel factor: its colour is multiplied by this.
    pub scale: f64,
    /// Light that is added whatever F0 is; 0 for cloth.
    pub bias: f64,
}

impl Albedo {
    /// Returns the light that a perfect mirror's facets reflect once. The rest they reflect more often.
    pub fn total(self) -> f64 {
        self.scale + self.bias
    }
}
