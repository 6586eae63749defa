//! Filters of Table 1 of Greene & Heckbert 1986, beside EWA: each as its own paper has it, over a footprint of a world.
//!
//! They are slow and plain, and serve to be compared. Each averages one footprint after the other, across the edges of
//! views as far as its method goes.

mod blinn_newell;
mod catmull;
mod ewa_integer;
mod ewa_paper;
mod feibush_levoy_cook;
mod gangnet;
mod method;
mod prefiltered;
mod tables;
mod two_pass;
mod weighing;

pub use prefiltered::IntegrationOrder;
pub use tables::ClassicTables;
pub(crate) use two_pass::{Passes, TwoPass};

use super::Kernel;
use super::traits::{Filter, PrepareError, Prepared, SetupCost};
use crate::raster::Rgba;
use crate::world::{Light, World};
use method::Method;
use prefiltered::{MipMap, RepeatedIntegration, SummedArea};
use weighing::ScreenKernel;

/// Generates [`Classic`] from its table: of each filter the value, its name and a line of help, and the constructor of its
/// method, which is given the kernel on the screen.
macro_rules! classics {
    ($(
        $(#[$about:meta])*
        $Variant:ident $(($parameter:ident: $Type:ty = $usual:expr))? = $name:literal, $help:literal, $method:expr;
    )*) => {
        /// A filter of the literature that EWA is compared with.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Classic {
            $($(#[$about])* $Variant $(($Type))?,)*
        }

        impl Classic {
            /// All filters, in the order of the table. One with a parameter has its usual value.
            pub const ALL: &'static [Self] = &[$(Self::$Variant $(($usual))?,)*];

            /// Names, each with a line of help, in the order of [`Classic::ALL`].
            pub const NAMES: &'static [(&'static str, &'static str)] = &[$(($name, $help),)*];

            /// Returns the name, without a parameter.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$Variant { .. } => $name,)*
                }
            }

            /// Returns the method; a Gaussian is weighed by on the screen if it has the choice.
            fn method(self, kernel: &Kernel) -> Box<dyn Method> {
                match self {
                    $(Self::$Variant $(($parameter))? => made($method, kernel),)*
                }
            }
        }
    };
}

classics! {
    /// Squares averaged beforehand, interpolated on two levels of a pyramid (Williams 1983).
    MipMap = "mipmap", "Williams' trilinear pyramid of squares (:levels=nearest|trilinear)", |_| MipMap::Trilinear;
    /// The nearest square of the nearest level of a pyramid (Dungan, Stenger & Sutty 1978).
    NearestMipMap = "mipmap:levels=nearest", "Squares of the nearest level (Dungan, Stenger, Sutty)", |_| MipMap::Nearest;
    /// Rectangles by a table of sums (Crow 1984).
    SummedArea = "summed-area", "Crow's rectangles by a table of sums", |_| SummedArea;
    /// Smooth splines over an upright box, by differences in a picture that is integrated several times (Perlin; Heckbert
    /// 1986).
    RepeatedIntegration(order: IntegrationOrder = IntegrationOrder::USUAL) =
        "repeated-integration", "Splines by sums of sums (:order=N, 1 to 4, default 2)", |_| RepeatedIntegration(order);
    /// Exact areas under the quadrilateral of the pixel's corners, evenly weighted (Catmull 1974).
    Catmull = "catmull", "Exact areas under the pixel, evenly weighted", |_| catmull::Catmull;
    /// A pyramid over the parallelogram of the pixels around (Blinn & Newell 1976).
    BlinnNewell = "blinn-newell", "A pyramid over the parallelogram of a pixel", |_| blinn_newell::BlinnNewell;
    /// Texels mapped to the screen, and weighed there by a round kernel (Feibush, Levoy & Cook 1980).
    FeibushLevoyCook = "feibush-levoy-cook", "Texels weighed on the screen by a table", feibush_levoy_cook::FeibushLevoyCook;
    /// Samples of the screen mapped to the texels, in a round kernel (Gangnet, Perny & Coueignoux 1982).
    Gangnet = "gangnet", "Samples of the screen in a round kernel", gangnet::Gangnet;
    /// Two passes of one dimension each, along the rows and along the columns (Catmull & Smith 1980).
    TwoPass = "two-pass", "Rows first and then columns, each of one dimension", two_pass::TwoPass;
    /// EWA as printed, with a Gaussian and finite differences (Greene & Heckbert 1986).
    EwaPaper = "ewa:paper", "EWA as printed in 1986: a Gaussian, finite differences", ewa_paper::EwaPaper;
    /// EWA in integers, as the paper proposes.
    EwaInteger = "ewa:integer", "EWA as printed, in integers", ewa_integer::EwaInteger::new;
}

fn made<M: Method + 'static>(make: impl FnOnce(ScreenKernel) -> M, kernel: &Kernel) -> Box<dyn Method> {
    Box::new(make(ScreenKernel::of(kernel)))
}

impl Classic {
    /// Returns the filter of a name; one with a parameter has its usual value.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|classic| classic.name() == name)
    }

    /// Returns the filter with a kernel: a Gaussian is weighed by on the screen, and others have no effect.
    pub fn with(self, kernel: Kernel) -> WeighedClassic {
        WeighedClassic { classic: self, kernel }
    }
}

/// A filter of the literature with the kernel that it weighs by on the screen, if it has the choice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeighedClassic {
    classic: Classic,
    kernel: Kernel,
}

impl WeighedClassic {
    /// Checks that the filter loses no precision over a world.
    ///
    /// # Errors
    /// For repeated integration over a view that is too large for its order.
    pub fn check(&self, world: &World) -> Result<(), PrepareError> {
        self.method().check(world)
    }

    /// Returns the kernel by which the filter weighs on the screen: the Gaussian of its table, or a box; `None` if it has a
    /// shape of its own.
    pub fn shape(&self) -> Option<Kernel> {
        self.method().kernel()
    }

    /// Returns a kernel that reaches all texels that are read for a pixel. Of two levels, the coarser has texels of two pixels,
    /// and is interpolated over one more.
    pub(crate) fn reaching_kernel(&self) -> Kernel {
        Kernel { scale: self.method().reach().max(2.0), ..Kernel::ADAPTIVE }
    }

    /// Makes the filter's tables of texels in the order of a world's light, all of them finite.
    pub fn tables(&self, world: &World, light: &[Rgba]) -> ClassicTables {
        ClassicTables::new(self.method().tables(world, light))
    }

    fn method(&self) -> Box<dyn Method> {
        self.classic.method(&self.kernel)
    }
}

impl Filter for WeighedClassic {
    fn prepare<'w>(&self, world: &'w World, light: &'w Light) -> Result<Box<dyn Prepared + 'w>, PrepareError> {
        light.check(world)?;
        self.check(world)?;
        Ok(self.tables(world, light.texels()).over(world, light.texels()))
    }

    fn setup(&self, world: &World) -> SetupCost {
        self.method().setup(world)
    }
}

/// Weighs by the paper's Gaussian on the screen.
impl Filter for Classic {
    fn prepare<'w>(&self, world: &'w World, light: &'w Light) -> Result<Box<dyn Prepared + 'w>, PrepareError> {
        self.with(Kernel::ADAPTIVE).prepare(world, light)
    }

    fn setup(&self, world: &World) -> SetupCost {
        self.with(Kernel::ADAPTIVE).setup(world)
    }
}
