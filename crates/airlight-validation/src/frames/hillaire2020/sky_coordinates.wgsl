// Directions of the sky-view table: azimuth from the sun, and latitude from the horizon, denser towards it (section 5.3).

/// Azimuth and elevation of the centre of a texel, by its coordinates.
fn sky_angles(place: vec2<f32>) -> vec2<f32> {
    let away = 2.0 * place.y - 1.0;
    let end = select(-0.5 * PI, 0.5 * PI, away >= 0.0);
    return vec2<f32>(2.0 * PI * place.x, view.horizon_rad + (end - view.horizon_rad) * away * away);
}

/// Coordinates of a direction: the inverse.
fn sky_coordinates(direction: vec3<f32>) -> vec2<f32> {
    let azimuth = atan2(direction.z, direction.x) - atan2(view.sun.z, view.sun.x);
    let above = asin(clamp(direction.y, -1.0, 1.0)) - view.horizon_rad;
    let end = select(-0.5 * PI, 0.5 * PI, above >= 0.0) - view.horizon_rad;
    return vec2<f32>(azimuth / (2.0 * PI), 0.5 + 0.5 * sign(above) * sqrt(above / end));
}
