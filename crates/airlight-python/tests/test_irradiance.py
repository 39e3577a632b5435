"""Irradiance over a time index, beside pvlib."""

import numpy as np
import pytest

import airlight
from airlight import irradiance

pandas = pytest.importorskip("pandas")
PLACE = (48.86, 2.29)


@pytest.fixture(scope="module")
def day():
    """Hours of a midsummer day."""
    return pandas.date_range("2026-06-21T04:00", "2026-06-21T20:00", freq="2h", tz="UTC")


@pytest.fixture(scope="module")
def table(day):
    return irradiance.clear_sky(day, *PLACE, atmosphere="average")


def test_table_has_a_row_for_each_time(day, table):
    assert (table.index == day).all()
    total = table.direct_horizontal + table.diffuse_horizontal
    np.testing.assert_allclose(table.global_horizontal, total, rtol=1e-6)
    assert (table.global_horizontal.iloc[2:7] > 100).all()
    assert table.direct_normal.max() < 900


@pytest.mark.slow
def test_bands_are_the_integrals_of_the_spectra(day, table):
    pytest.importorskip("xarray")
    spectra = irradiance.clear_sky_spectra(day[[4]], *PLACE, atmosphere="average")
    band = np.trapezoid(spectra.diffuse_horizontal.values[0], spectra.wavelength)
    assert band == pytest.approx(table.diffuse_horizontal.iloc[4], rel=1e-5)
    assert spectra.time.values[0] == day[4].tz_localize(None).to_datetime64()
    assert spectra.direct_normal.attrs["units"] == "W m-2 nm-1"


def test_spectra_are_those_of_spectrl2_with_the_same_air(day):
    pytest.importorskip("pvlib")
    from pvlib.spectrum import spectrl2

    for elevation_deg in (60.0, 20.0):
        air = airlight.Atmosphere("average")
        nm = np.arange(420.0, 681.0, 20.0)
        sky = airlight.Sky(air, wavelengths=nm, sun_elevation_deg=elevation_deg)
        view = sky.view(sun_elevation_deg=elevation_deg)
        aerosol_500 = 0.12 * (500 / 550) ** -1.3
        from pvlib.atmosphere import get_relative_airmass

        found = spectrl2(
            apparent_zenith=90 - elevation_deg,
            aoi=90 - elevation_deg,
            surface_tilt=0,
            ground_albedo=0.1,
            surface_pressure=101325,
            relative_airmass=get_relative_airmass(90 - elevation_deg),
            precipitable_water=1.0,
            ozone=0.3,
            aerosol_turbidity_500nm=aerosol_500,
            dayofyear=94,
        )
        at = np.ravel(found["wavelength"])
        direct = np.interp(nm, at, np.ravel(found["dni"]))
        ratio = view.sun_irradiance() / direct
        assert abs(ratio.mean() - 1) < 0.06, (elevation_deg, ratio)


def test_horizontal_surfaces_are_those_among_tilted_ones():
    sky = airlight.Sky("hazy", wavelengths=[450, 550, 650], sun_elevation_deg=40, altitude_m=3e3)
    view = sky.view(3e3, sun_elevation_deg=40)
    up, down = view.irradiance([[0, 1, 0], [0, -1, 0]])
    np.testing.assert_allclose(view.downwelling_irradiance(), up, rtol=0.01)
    np.testing.assert_allclose(view.upwelling_irradiance(), down, rtol=0.01)
