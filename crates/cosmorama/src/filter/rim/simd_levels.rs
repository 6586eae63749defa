use fearless_simd::Level;

/// Returns the levels of SIMD instructions that this machine has.
pub(crate) fn levels() -> Vec<Level> {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    use fearless_simd::Simd;

    let best = Level::new();
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    let between = [best.as_sse4_2().map(|simd| simd.level()), best.as_avx2().map(|simd| simd.level())];
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    let between = [None; 2];
    [Some(Level::baseline()), Some(best)].into_iter().chain(between).flatten().collect()
}
