//! Options that describe fog, shared by all commands that draw it.

use crate::parse::{self, words::Words};
use airlight::fog::FogScattering;
use airlight::fog::droplets::DropletKind;
use airlight::scene::{FogLayerSpec, FogPatchesSpec, FogProfile, FogSpec};
use clap::Args;

/// Contrast threshold that defines visibility.
#[derive(Clone, Debug, Default, Args)]
pub struct ContrastArgs {
    /// Contrast threshold of visibility: 0.05 (meteorological optical range) or 0.02 (Koschmieder's visual range) [default: 0.05]
    #[arg(long, value_name = "C", value_parser = parse::contrast, help_heading = "Air")]
    pub contrast: Option<f64>,
}

/// Fog in the air. Heights are above the ground.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Fog")]
pub struct FogArgs {
    /// Visibility where the fog is densest, m: the distance at which contrast falls to --contrast
    #[arg(long, value_name = "M", value_parser = parse::length_m)]
    pub visibility_m: Option<f64>,
    /// Density by height [default: slab with --top-m, otherwise clamped; for `airlight fog` without any height: uniform]
    #[arg(long, value_name = "PROFILE", value_parser = parse::named::<FogProfile>())]
    pub fog_profile: Option<FogProfile>,
    /// Height over which the density falls by a factor e, m (height, clamped, unclamped) [default: 50]
    #[arg(long, value_name = "M", value_parser = parse::length_m)]
    pub scale_height_m: Option<f64>,
    /// Height above which the density decreases (clamped) or at which the visibility is --visibility-m (unclamped), m [default: 0]
    #[arg(long, value_name = "M", value_parser = parse::number)]
    pub base_height_m: Option<f64>,
    /// Height of the top, m (slab) [default: 50]
    #[arg(long, value_name = "M", value_parser = parse::length_m)]
    pub top_m: Option<f64>,
    /// Droplets of the fog [default: radiation]
    #[arg(long, value_name = "KIND", value_parser = parse::named::<DropletKind>())]
    pub droplets: Option<DropletKind>,
    /// Orders of scattering in the fog; without effect in uniform fog, which is lit uniformly [default: all]
    #[arg(long, value_name = "WHICH", value_parser = parse::named::<FogScattering>())]
    pub fog_scattering: Option<FogScattering>,
    /// Strength of patches in the fog: standard deviation of the density relative to its mean, 0 to 2 [default: even fog; 0.5 with
    /// another --patch option]
    #[arg(long, value_name = "S", value_parser = parse::patch_strength)]
    pub patch_strength: Option<f64>,
    /// Width of a typical patch, m [default: 30]
    #[arg(long, value_name = "M", value_parser = parse::length_m)]
    pub patch_size_m: Option<f64>,
    /// Height of a typical patch, m [default: a third of --patch-size-m]
    #[arg(long, value_name = "M", value_parser = parse::length_m)]
    pub patch_height_m: Option<f64>,
    /// Seed of the patches [default: 0]
    #[arg(long, value_name = "N")]
    pub patch_seed: Option<u64>,
    /// Wind that moves the patches, to the east and to the north, m/s [default: 0,0]
    #[arg(long, value_name = "EAST,NORTH", value_parser = parse::two_numbers, allow_hyphen_values = true)]
    pub patch_wind: Option<(f64, f64)>,
    /// Time for which that wind has moved the patches, s; in a sequence, at its first picture [default: 0]
    #[arg(long, value_name = "S", value_parser = parse::number)]
    pub patch_time_s: Option<f64>,
    /// Further layer of fog, as in 'visibility=500 scale-height=20'; can be repeated
    ///
    /// KEY=VALUE pairs: visibility (m, as --visibility-m), and scale-height (m), base (m), top (m), droplets and profile as the
    /// corresponding options. Without profile and heights the layer is uniform; with scale-height only, its profile is height.
    #[arg(long, value_name = "LAYER", value_parser = layer)]
    pub layer: Vec<FogLayerSpec>,
}

impl FogArgs {
    /// Overrides values of a scene's fog; adds fog to a scene without it if any option is given.
    pub fn fill(&self, fog: &mut Option<FogSpec>) {
        let mut filled = fog.clone().unwrap_or_default();
        let put = |value: &mut Option<f64>, given: Option<f64>| *value = given.or(*value);
        put(&mut filled.visibility_m, self.visibility_m);
        put(&mut filled.scale_height_m, self.scale_height_m);
        put(&mut filled.base_height_m, self.base_height_m);
        put(&mut filled.top_m, self.top_m);
        filled.profile = self.fog_profile.or(filled.profile);
        filled.droplets = self.droplets.or(filled.droplets);
        filled.scattering = self.fog_scattering.or(filled.scattering);
        let mut patches = filled.patches.clone().unwrap_or_default();
        put(&mut patches.strength, self.patch_strength);
        put(&mut patches.size_m, self.patch_size_m);
        put(&mut patches.height_m, self.patch_height_m);
        put(&mut patches.time_s, self.patch_time_s);
        patches.seed = self.patch_seed.or(patches.seed);
        let wind = self.patch_wind.map(|(east, north)| [east, north]);
        patches.wind_m_s = wind.or(patches.wind_m_s);
        if patches != FogPatchesSpec::default() {
            filled.patches = Some(patches);
        }
        if !self.layer.is_empty() {
            filled.layers = self.layer.clone();
        }
        if filled != FogSpec::default() {
            *fog = Some(filled);
        }
    }
}

/// A layer of fog from KEY=VALUE pairs.
fn layer(text: &str) -> Result<FogLayerSpec, String> {
    const KEYS: [&str; 6] = [
        "visibility",
        "profile",
        "scale-height",
        "base",
        "top",
        "droplets",
    ];
    let mut words = Words::new(text, &KEYS)?;
    let visibility_m = words
        .take("visibility", parse::length_m)?
        .ok_or("expected visibility=METRES, got none; try visibility=500")?;
    let profile = words.take("profile", parse::value_of::<FogProfile>)?;
    let scale_height_m = words.take("scale-height", parse::length_m)?;
    let base_height_m = words.take("base", parse::number)?;
    let top_m = words.take("top", parse::length_m)?;
    let droplets = words.take("droplets", parse::value_of::<DropletKind>)?;
    let profile = match (profile, scale_height_m, base_height_m, top_m) {
        (Some(profile), ..) => Some(profile),
        (None, None, None, None) => Some(FogProfile::Uniform),
        (None, None, Some(_), None) => {
            return Err(
                "expected base with scale-height, got base alone; try scale-height=20".to_owned(),
            );
        }
        (None, Some(_), None, None) => Some(FogProfile::Height),
        (None, None, None, Some(_)) | (None, Some(_), Some(_), None) => None,
        (None, _, _, Some(_)) => {
            return Err(
                "expected top alone, as a layer with a top is uniform below it, got scale-height or base too; try leaving these out"
                    .to_owned(),
            );
        }
    };
    Ok(FogLayerSpec {
        visibility_m: Some(visibility_m),
        profile,
        scale_height_m,
        base_height_m,
        top_m,
        droplets,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_are_parsed() {
        let profile = |text| layer(text).unwrap().implied_profile();
        assert_eq!(profile("visibility=200"), FogProfile::Uniform);
        assert_eq!(profile("top=9  visibility=200"), FogProfile::Slab);
        assert_eq!(profile("visibility=9 scale-height=5"), FogProfile::Height);
        let clamped = layer("visibility=5 scale-height=20 base=-3 droplets=fine").unwrap();
        assert_eq!(clamped.implied_profile(), FogProfile::Clamped);
        assert_eq!(
            (clamped.base_height_m, clamped.scale_height_m),
            (Some(-3.0), Some(20.0))
        );
        assert_eq!(
            profile("visibility=5 scale-height=20 profile=unclamped"),
            FogProfile::Unclamped
        );
        for (text, part) in [
            ("", "visibility="),
            ("visibility=0", "above 0"),
            ("visibility=NaN", "above 0"),
            ("visibility=5 base=3", "scale-height"),
            ("visibility=5 top=3 scale-height=3", "top alone"),
            ("visibility=5 droplets=soup", "(fine, radiation,"),
            ("visibility=5 profile=thick", "foggy-cityscapes"),
            ("visibility=5 visibility=6", "twice"),
            ("visibility=5 colour=red", "colour"),
            ("visibility", "KEY=VALUE"),
        ] {
            let error = layer(text).unwrap_err();
            assert!(error.contains(part), "{text}: {error}");
        }
    }

    #[test]
    fn options_override_only_given_values() {
        let mut fog = None;
        FogArgs::default().fill(&mut fog);
        assert_eq!(fog, None);
        let args = FogArgs {
            visibility_m: Some(80.0),
            droplets: Some(DropletKind::Isotropic),
            ..FogArgs::default()
        };
        let mut fog = Some(FogSpec {
            visibility_m: Some(50.0),
            top_m: Some(9.0),
            ..FogSpec::default()
        });
        args.fill(&mut fog);
        let fog = fog.unwrap();
        assert_eq!((fog.visibility_m, fog.top_m), (Some(80.0), Some(9.0)));
        assert_eq!(fog.droplets, Some(DropletKind::Isotropic));
        assert_eq!(fog.patches, None);
        let args = FogArgs {
            patch_seed: Some(4),
            patch_wind: Some((2.0, -1.0)),
            ..FogArgs::default()
        };
        let mut fog = Some(FogSpec {
            patches: Some(FogPatchesSpec {
                strength: Some(0.7),
                seed: Some(3),
                ..Default::default()
            }),
            ..FogSpec::default()
        });
        args.fill(&mut fog);
        let patches = fog.unwrap().patches.unwrap();
        assert_eq!((patches.strength, patches.seed), (Some(0.7), Some(4)));
        assert_eq!(patches.wind_m_s, Some([2.0, -1.0]));
    }
}
