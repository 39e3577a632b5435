// Colour: radiance at four wavelengths, XYZ, linear RGB spaces, sRGB signals. XYZ is relative to D65.

/// Weights of four wavelengths in red, green and blue, or in X, Y and Z.
struct RgbWeights {
    /// In red.
    red: vec4<f32>,
    /// In green.
    green: vec4<f32>,
    /// In blue.
    blue: vec4<f32>,
}

/// Red, green and blue of a radiance at four wavelengths.
///
/// Cost: no exp. Error: 1e-6 relative plus 1e-6 absolute.
fn rgb_from_spectrum(weights: RgbWeights, spectrum: vec4<f32>) -> vec3<f32> {
    return vec3<f32>(dot(weights.red, spectrum), dot(weights.green, spectrum), dot(weights.blue, spectrum));
}

/// XYZ of linear sRGB (IEC 61966-2-1), in the unit of its components.
///
/// Cost: no exp. Error: 3e-7 relative.
fn xyz_from_srgb(rgb: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        dot(vec3<f32>(0.412390799, 0.357584339, 0.180480788), rgb),
        dot(vec3<f32>(0.212639006, 0.715168679, 0.0721923154), rgb),
        dot(vec3<f32>(0.0193308187, 0.11919478, 0.950532152), rgb),
    );
}

/// Linear sRGB of XYZ, with negative components outside the gamut.
///
/// Cost: no exp. Error: 3e-7 relative plus 1e-6 absolute.
fn srgb_from_xyz(xyz: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        dot(vec3<f32>(3.24096994, -1.53738318, -0.49861076), xyz),
        dot(vec3<f32>(-0.969243636, 1.8759675, 0.0415550574), xyz),
        dot(vec3<f32>(0.0556300797, -0.203976959, 1.05697151), xyz),
    );
}

/// XYZ of linear BT.2020.
///
/// Cost: no exp. Error: 3e-7 relative.
fn xyz_from_rec2020_rgb(rgb: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        dot(vec3<f32>(0.636958048, 0.144616904, 0.168880975), rgb),
        dot(vec3<f32>(0.262700212, 0.677998072, 0.0593017165), rgb),
        dot(vec3<f32>(0.0, 0.028072693, 1.06098506), rgb),
    );
}

/// Linear BT.2020 of XYZ, with negative components outside the gamut.
///
/// Cost: no exp. Error: 3e-7 relative plus 1e-6 absolute.
fn rec2020_from_xyz(xyz: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        dot(vec3<f32>(1.71665119, -0.355670784, -0.253366281), xyz),
        dot(vec3<f32>(-0.666684352, 1.61648124, 0.0157685458), xyz),
        dot(vec3<f32>(0.0176398574, -0.0427706133, 0.942103121), xyz),
    );
}

/// XYZ of ACEScg, whose white is adapted to D65 by Bradford's transform: what is neutral stays neutral.
///
/// Cost: no exp. Error: 3e-7 relative plus 1e-7 absolute.
fn xyz_from_acescg(rgb: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        dot(vec3<f32>(0.652237542, 0.128236136, 0.169982249), rgb),
        dot(vec3<f32>(0.26767218, 0.674339989, 0.0579878311), rgb),
        dot(vec3<f32>(-0.00538181577, 0.00136906021, 1.09307051), rgb),
    );
}

/// ACEScg of XYZ, D65 adapted to its white by Bradford's transform.
///
/// Cost: no exp. Error: 3e-7 relative plus 1e-6 absolute.
fn acescg_from_xyz(xyz: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        dot(vec3<f32>(1.66058533, -0.315295561, -0.241509328), xyz),
        dot(vec3<f32>(-0.659926063, 1.60839147, 0.0172985947), xyz),
        dot(vec3<f32>(0.00900256914, -0.00356687639, 0.913643313), xyz),
    );
}

/// sRGB signal of linear components (IEC 61966-2-1), odd below 0 and not clipped above 1.
///
/// Cost: 3 exp. Error: 2e-6 relative.
fn srgb_encode(linear: vec3<f32>) -> vec3<f32> {
    let v = abs(linear);
    let curved = 1.055 * pow(max(v, vec3<f32>(0.0031308)), vec3<f32>(0.4166666667)) - 0.055;
    return sign(linear) * select(curved, 12.92 * v, v <= vec3<f32>(0.0031308));
}

/// Linear components of an sRGB signal, the inverse of `srgb_encode`.
///
/// Cost: 3 exp. Error: 2e-6 relative.
fn srgb_decode(signal: vec3<f32>) -> vec3<f32> {
    let v = abs(signal);
    let curved = pow((v + 0.055) / 1.055, vec3<f32>(2.4));
    return sign(signal) * select(curved, v / 12.92, v <= vec3<f32>(0.04045));
}

/// Luminance of linear sRGB with the rounded weights of BT.709, in the unit of its components.
///
/// Cost: no exp. Error: 3e-7 relative plus 1e-6 absolute.
fn srgb_luminance(rgb: vec3<f32>) -> f32 {
    return dot(vec3<f32>(0.2126, 0.7152, 0.0722), rgb);
}

/// Linear sRGB moved towards grey of the same luminance until no component is negative; black where the luminance is not positive.
///
/// Cost: no exp. Error: 1e-6 relative plus 4e-7 absolute.
fn without_negatives(rgb: vec3<f32>) -> vec3<f32> {
    let bottom = min(rgb.x, min(rgb.y, rgb.z));
    if bottom >= 0.0 {
        return rgb;
    }
    let grey = max(srgb_luminance(rgb), 0.0);
    return max(grey + grey / (grey - bottom) * (rgb - grey), vec3<f32>(0.0));
}

/// Linear sRGB moved towards grey of the same luminance until all components are from 0 to 1.
///
/// Cost: no exp. Error: 1e-6 relative plus 8e-7 absolute.
fn into_unit_cube(rgb: vec3<f32>) -> vec3<f32> {
    let positive = without_negatives(rgb);
    let top = max(positive.x, max(positive.y, positive.z));
    if top <= 1.0 {
        return positive;
    }
    let grey = srgb_luminance(positive);
    if grey >= 1.0 {
        return vec3<f32>(1.0);
    }
    return clamp(grey + (1.0 - grey) / (top - grey) * (positive - grey), vec3<f32>(0.0), vec3<f32>(1.0));
}
