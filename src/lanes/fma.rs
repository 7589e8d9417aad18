//! Fused multiply–add.

/// `a · b + c`, with one rounding and one instruction where the target supports it. Elsewhere
/// `f64::mul_add` would call a slow library function, so the product and the sum are rounded
/// separately.
#[inline(always)]
pub fn fma(a: f64, b: f64, c: f64) -> f64 {
    if cfg!(any(target_feature = "fma", target_arch = "aarch64")) { a.mul_add(b, c) } else { a * b + c }
}
