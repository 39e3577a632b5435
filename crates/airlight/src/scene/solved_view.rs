//! Views of a solved sky, with or without fog.

use super::fog_in_sky::FogInSky;
use super::irradiance_map::horizontal_irradiance_around;
use super::light::LitSky;
use super::model::RowDirections;
use super::sun_disc_table::SunDiscTable;
use super::{Channels, FogLayers, IrradianceMap, RadianceView, RowSampler, SceneError};
use crate::axes;
use crate::control::{Cancelled, Control};
use crate::math::parallel;
use crate::sky::{
    LightSource, LineOfSight, PolarisationTable, PolarisedLight, SkyColumns, SkyTable, View,
};
use crate::spectrum::WavelengthGrid;
use crate::sun::SunDisc;
use glam::DVec3;
use std::fmt;
use std::sync::{Arc, OnceLock};

/// A solved sky with optional fog, in the channels of a picture. Tables that not every caller needs are computed on first
/// use.
pub(crate) struct SolvedView {
    view: View,
    channels: Channels,
    /// Wavelengths with the solar irradiance at the sun's distance, for spectral values.
    grid: Option<WavelengthGrid>,
    /// Table of the sky without fog; without it every direction is integrated.
    clear: Option<Arc<SkyTable>>,
    fog: Option<Arc<FogInSky>>,
    /// Air without fog, for path optics in front of objects.
    air: OnceLock<FogInSky>,
    disc: OnceLock<Option<SunDiscTable>>,
    irradiance: OnceLock<IrradianceMap>,
    /// Irradiance of a horizontal surface by the sky.
    horizontal_irradiance: OnceLock<Vec<f32>>,
}

impl View {
    /// The light of this view through the interface of all models, tabulated in `channels`, as pictures are drawn from it.
    pub fn radiance_view(&self, channels: Channels) -> Arc<dyn RadianceView> {
        self.radiance_view_with(channels, Control::default())
            .expect("nothing cancels it")
    }

    /// As [`View::radiance_view`], with cancellation.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn radiance_view_with(
        &self,
        channels: Channels,
        control: Control<'_>,
    ) -> Result<Arc<dyn RadianceView>, Cancelled> {
        match SolvedView::new(self.clone(), None, channels, control) {
            Ok(solved) => Ok(Arc::new(solved)),
            Err(error) if error.is_cancelled() => Err(Cancelled),
            Err(error) => unreachable!("a view without fog is valid in all channels: {error}"),
        }
    }
}

impl SolvedView {
    /// Tabulates the sky of a view, with or without fog.
    ///
    /// # Errors
    /// [`SceneError`] for fog that is refused, and if the caller cancelled.
    pub fn new(
        view: View,
        fog: Option<&FogLayers>,
        channels: Channels,
        control: Control<'_>,
    ) -> Result<Self, SceneError> {
        Self::with_glow(view, &[], fog, channels, control)
    }

    /// [`Self::new`] in which fog also scatters a glow of the sky, given by its mean radiance in the channels.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_glow(
        view: View,
        glow: &[f32],
        fog: Option<&FogLayers>,
        channels: Channels,
        control: Control<'_>,
    ) -> Result<Self, SceneError> {
        let lit = LitSky { view: &view, glow };
        let fog = match fog {
            Some(fog) => Some(Arc::new(FogInSky::new(Some(fog), lit, channels, control)?)),
            None => None,
        };
        let clear = match &fog {
            Some(fog) => fog.clear().clone(),
            None => Arc::new(view.table_with(channels, control)?),
        };
        Ok(Self::of(view, channels, Some(clear), fog))
    }

    /// The sky of a view without fog and without a table, for few directions: each is integrated.
    pub fn without_table(view: View, channels: Channels) -> Self {
        Self::of(view, channels, None, None)
    }

    fn of(
        view: View,
        channels: Channels,
        clear: Option<Arc<SkyTable>>,
        fog: Option<Arc<FogInSky>>,
    ) -> Self {
        let grid = match channels {
            Channels::Spectral => {
                let factor = match view.source() {
                    LightSource::Sun(sun) => sun.irradiance_factor(),
                    LightSource::Moon(_) => 1.0,
                };
                Some(view.sky().grid().with_solar_factor(factor))
            }
            Channels::Rgb(_) => None,
        };
        Self {
            view,
            channels,
            grid,
            clear,
            fog,
            air: OnceLock::new(),
            disc: OnceLock::new(),
            irradiance: OnceLock::new(),
            horizontal_irradiance: OnceLock::new(),
        }
    }

    /// The view of the solved sky.
    pub fn sky_view(&self) -> &View {
        &self.view
    }

    /// The fog, if any.
    pub(super) fn fog(&self) -> Option<&Arc<FogInSky>> {
        self.fog.as_ref()
    }

    /// Transmittance of the air without fog between the eye and a point at a distance, m.
    pub fn air_transmittance(&self, direction: DVec3, distance_m: f64, out: &mut [f32]) {
        self.air().air_transmittance(direction, distance_m, out);
    }

    /// Air with fog, if any.
    fn air(&self) -> &FogInSky {
        match &self.fog {
            Some(fog) => fog,
            None => self.air.get_or_init(|| {
                FogInSky::new(None, (&self.view).into(), self.channels, Control::default())
                    .expect("channels of a view without fog are valid")
            }),
        }
    }

    #[inline]
    fn sample(&self, direction: DVec3, out: &mut [f32]) {
        if direction == DVec3::ZERO {
            out.fill(0.0);
            return;
        }
        match &self.clear {
            Some(table) => table.sample(direction, out),
            None => self.put(&self.view.along(direction, None).radiance(), out),
        }
        if let Some(fog) = &self.fog {
            fog.cover(direction, out);
        }
    }

    /// Converts values at the wavelengths of the sky to channels.
    fn put(&self, spectrum: &[f32], out: &mut [f32]) {
        match self.channels {
            Channels::Spectral => out.copy_from_slice(spectrum),
            Channels::Rgb(space) => {
                let rgb = space.from_xyz(self.view.sky().grid().to_xyz(spectrum));
                out.iter_mut().zip(rgb).for_each(|(out, v)| *out = v as f32);
            }
        }
    }
}

impl RadianceView for SolvedView {
    fn channels(&self) -> Channels {
        self.channels
    }

    fn grid(&self) -> Option<&WavelengthGrid> {
        self.grid.as_ref()
    }

    fn sun(&self) -> DVec3 {
        self.view.sun()
    }

    fn disc(&self) -> &SunDisc {
        self.view.disc()
    }

    fn horizon_elevation_rad(&self) -> f64 {
        self.view.horizon_elevation_rad()
    }

    fn polarised(&self, direction: DVec3) -> Option<PolarisedLight> {
        let clear = self.fog.is_none();
        clear.then(|| self.view.polarised(direction))
    }

    fn polarisation_table(&self) -> Option<PolarisationTable> {
        let clear = self.fog.is_none();
        clear.then(|| PolarisationTable::new(&self.view))
    }

    fn averages_horizon(&self) -> bool {
        true
    }

    fn radiance(&self, directions: &[DVec3], out: &mut [f32]) {
        match &self.clear {
            Some(table) => table.samples_on_this_thread(directions, out),
            None => {
                let values = out.chunks_exact_mut(self.channel_count());
                for (&direction, values) in directions.iter().zip(values) {
                    self.sample(direction, values);
                }
            }
        }
        let values = out.chunks_exact_mut(self.channel_count());
        for (&direction, values) in directions.iter().zip(values) {
            if direction == DVec3::ZERO {
                values.fill(0.0);
            } else if let Some(fog) = &self.fog {
                fog.cover(direction, values);
            }
        }
    }

    fn row_sampler(&self, azimuths_rad: &[f64]) -> Option<Box<dyn RowSampler>> {
        let clear = self.clear.clone()?;
        let sun_rad = axes::azimuth_deg(self.sun()).to_radians();
        let columns = clear.columns(azimuths_rad.iter().map(|rad| rad - sun_rad));
        let fog = self.fog.as_ref();
        Some(Box::new(SolvedRows {
            clear,
            columns,
            fog: fog.map(|fog| (fog.clone(), RowDirections::new(azimuths_rad))),
        }))
    }

    fn sun_disc(&self, directions: &[DVec3], out: &mut [f32]) {
        let table = self.disc.get_or_init(|| {
            let fog = |direction| {
                self.fog
                    .as_ref()
                    .map_or(1.0, |fog| fog.transmittance(direction))
            };
            SunDiscTable::new(&self.view, self.channels, self.horizon_elevation_rad(), fog)
        });
        let Some(table) = table else {
            out.fill(0.0);
            return;
        };
        let values = out.chunks_exact_mut(self.channel_count());
        for (&direction, values) in directions.iter().zip(values) {
            table.sample(direction, values);
            let relative = self.view.source().relative_radiance(direction) as f32;
            values.iter_mut().for_each(|v| *v *= relative);
        }
    }

    fn irradiance(&self, normals: &[DVec3], out: &mut [f32]) {
        let count = self.channel_count();
        let map = self.irradiance.get_or_init(|| {
            parallel::apart(|| {
                IrradianceMap::new(self.sun(), count, |directions, out| {
                    self.radiance(directions, out)
                })
            })
        });
        for (&normal, out) in normals.iter().zip(out.chunks_exact_mut(count)) {
            map.irradiance(normal, out);
        }
    }

    fn horizontal_irradiance(&self, out: &mut [f32]) {
        let compute = || {
            let mut sum = vec![0.0; self.channel_count()];
            match (&self.clear, &self.fog) {
                (None, _) => {
                    self.put(&self.view.downwelling_irradiance(), &mut sum);
                    return sum;
                }
                (Some(table), None) => return table.irradiance(DVec3::Y),
                (Some(_), Some(_)) => {}
            }
            horizontal_irradiance_around(self.sun(), &mut sum, |direction, values| {
                self.sample(direction, values);
            });
            sum
        };
        let irradiance = self
            .horizontal_irradiance
            .get_or_init(|| parallel::apart(compute));
        out.copy_from_slice(irradiance);
    }

    fn sun_irradiance(&self, out: &mut [f32]) {
        let through = self
            .fog
            .as_ref()
            .map_or(1.0, |fog| fog.transmittance(self.sun()));
        let spectrum: Vec<f32> = self
            .view
            .sun_irradiance()
            .iter()
            .map(|e| e * through)
            .collect();
        self.put(&spectrum, out);
    }

    fn sunlight(&self, height_m: f64, out: &mut [f32]) {
        self.air().sunlight(height_m, out);
    }

    fn path(
        &self,
        direction: DVec3,
        distance_m: f64,
        transmittance: &mut [f32],
        path_radiance: &mut [f32],
    ) {
        self.air()
            .path(direction, distance_m, transmittance, path_radiance);
    }

    fn line_of_sight(&self, direction: DVec3, limit_m: Option<f64>) -> Option<LineOfSight> {
        Some(self.view.along(direction, limit_m))
    }
}

impl fmt::Debug for SolvedView {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SolvedView")
            .field("sky", self.view.sky())
            .field("channels", &self.channels)
            .field("fog", &self.fog.is_some())
            .finish_non_exhaustive()
    }
}

/// Row sampler of a solved sky for columns of constant azimuth.
struct SolvedRows {
    clear: Arc<SkyTable>,
    columns: SkyColumns,
    fog: Option<(Arc<FogInSky>, RowDirections)>,
}

impl RowSampler for SolvedRows {
    fn sample_row(&self, elevation_rad: f64, out: &mut [f32]) {
        self.clear.sample_row(elevation_rad, &self.columns, out);
        if let Some((fog, directions)) = &self.fog {
            let values = out.chunks_exact_mut(self.clear.channels());
            for (direction, values) in directions.at(elevation_rad).zip(values) {
                fog.cover(direction, values);
            }
        }
    }
}

impl fmt::Debug for SolvedRows {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SolvedRows").finish_non_exhaustive()
    }
}
