//! [`Pass::Sky`].

use crate::camera::{NEAR_M, SIZE, place_of, world_from_clip};
use crate::frame::{Drawn, FORMAT, both_forms, even_scene, texture};
use crate::vulkan;
use airlight::atmosphere;
use airlight::axes;
use airlight::sky::{Sky, SkySettings, SunCoverage};
use airlight::spectrum::RgbSpace;
use airlight_shaders::twins::colour::RgbWeights;
use airlight_shaders::twins::path_optics::apply_path_optics;
use airlight_shaders::{ColourFit, Pass, SkyTables, wavelength_grid};
use glam::Vec3;

const EYE: Vec3 = Vec3::new(0.0, 2.0, 0.0);
const COLOUR: [f32; 4] = [5000.0, 2500.0, 1250.0, 1.0];

fn tables() -> SkyTables {
    let air = atmosphere::preset("average").expect("a preset");
    let settings = SkySettings {
        suns: SunCoverage::near(20.0, 2.0),
        ..SkySettings::default()
    };
    let sky = Sky::prepare(&air, &wavelength_grid(), &settings).expect("a sky");
    let view = sky.view(2.0, axes::direction(20.0, 20.0));
    let fit = ColourFit::new(&air, settings.suns).expect("a fit");
    SkyTables::new(&view, &fit, RgbSpace::Srgb).expect("tables")
}

/// The uniform of the pass, 16 bytes a row.
fn uniform(tables: &SkyTables) -> Vec<u8> {
    let view = tables.view;
    let mut numbers = world_from_clip(EYE).to_cols_array().to_vec();
    numbers.extend(EYE.extend(0.0).to_array());
    numbers.extend(view.sun.extend(view.height_m).to_array());
    numbers.extend([
        view.ground_radius_m,
        view.air_height_m,
        view.horizon_rad,
        view.highest_rad,
    ]);
    numbers.extend([
        view.kink_rad,
        view.kink_place,
        view.dense_share,
        view.dense_azimuth,
    ]);
    numbers.extend([view.dense_width, view.even_below]);
    numbers.extend([view.jump_height_m, view.jump_place]);
    numbers.extend([view.jump_part, 0.0, 0.0, 0.0]);
    let rows = |weights: RgbWeights| [weights.red, weights.green, weights.blue];
    let mut vectors = vec![view.extinction_above, view.smooth_above, view.haze_above];
    vectors.extend([tables.scales.smooth_light, tables.scales.haze]);
    vectors.extend(rows(tables.radiance_weights));
    vectors.extend(rows(tables.transmittance_weights));
    numbers.extend(vectors.iter().flat_map(|vector| vector.to_array()));
    numbers.iter().flat_map(|x| x.to_ne_bytes()).collect()
}

#[test]
fn the_pass_draws_what_the_tables_hold() {
    let (_, device, queue) = vulkan::open();
    let tables = tables();
    let colours = texture(&device, SIZE, FORMAT).create_view(&Default::default());
    let depth_format = wgpu::TextureFormat::Depth32Float;
    let depth = texture(&device, SIZE, depth_format).create_view(&Default::default());
    let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..Default::default()
    });
    let held = [
        &tables.sky_smooth,
        &tables.sky_haze,
        &tables.aerial_smooth,
        &tables.aerial_haze,
        &tables.extinction,
        &tables.phase,
    ]
    .map(|table| vulkan::uploaded(&device, &queue, table));
    let mut resources = vec![
        wgpu::BindingResource::TextureView(&colours),
        wgpu::BindingResource::TextureView(&depth),
        wgpu::BindingResource::Sampler(&sampler),
    ];
    resources.extend(held.iter().map(wgpu::BindingResource::TextureView));
    let mut worst = 0.0_f32;
    for source in both_forms(Pass::Sky) {
        let on = (&device, &queue);
        let drawn = Drawn::new(on, source, "add_sky", SIZE, &uniform(&tables), &resources);
        // The sky, 50 km and 300 m.
        for at in [0.0, NEAR_M / 5e4, NEAR_M / 300.0] {
            let scene = even_scene(&device, [&colours, &depth], COLOUR, at);
            let frame = drawn.frame(scene);
            for (pixel, got) in frame.as_chunks::<4>().0.iter().enumerate() {
                let (direction, distance_m) = place_of(EYE, pixel as u32, at);
                let right = match at > 0.0 {
                    true => {
                        let path = tables.rgb_path(direction, distance_m);
                        apply_path_optics(path, Vec3::from_slice(&COLOUR))
                    }
                    false => tables.rgb_radiance(direction),
                };
                let difference = (Vec3::from_slice(got) - right) / right.max_element();
                worst = worst.max(difference.abs().max_element());
                assert_eq!(got[3], 1.0);
            }
        }
    }
    println!("worst difference, relative to the largest channel: {worst:e}");
    // The rounding of half floats.
    assert!(worst < 2e-3, "{worst}");
}
