"""Position of the sun."""

import datetime

import numpy as np
import pytest

import airlight


def test_position_matches_the_published_example():
    # Reda & Andreas 2004, table A5.1.
    place = {"latitude_deg": 39.742476, "longitude_deg": -105.1786, "altitude_m": 1830.14}
    sun = airlight.sun_position("2003-10-17T12:30:30-07:00", **place, pressure_pa=82_000, temperature_c=11)
    assert abs(90 - sun.elevation_deg[0] - 50.11162) < 1e-4
    assert abs(sun.azimuth_deg[0] - 194.34024) < 1e-4
    assert sun.direction.shape == (1, 3)


def test_times_of_all_kinds_are_the_same_time():
    texts = ["2026-06-21T12:00:00Z", "2026-12-21T15:30:00+02:00"]
    utc = [datetime.datetime.fromisoformat(text.replace("Z", "+00:00")) for text in texts]
    wide = np.array(["2026-06-21T12:00:00", "2026-12-21T13:30:00"], dtype="datetime64[s]")
    kinds = [texts, utc, wide, list(wide)]
    try:
        import pandas
    except ImportError:
        pass
    else:
        kinds.append(pandas.DatetimeIndex(wide).tz_localize("UTC").tz_convert("Asia/Tokyo"))
    positions = [airlight.sun_position(kind, 48.9, 2.3) for kind in kinds]
    for position in positions[1:]:
        np.testing.assert_allclose(position, positions[0], atol=1e-6)


@pytest.mark.parametrize("time", ["2026-06-21T12:00:00", datetime.datetime(2026, 6, 21), np.datetime64("NaT")])
def test_times_that_do_not_say_when_are_refused(time):
    with pytest.raises(ValueError, match="expected"):
        airlight.sun_position(time, 0, 0)


def test_places_off_the_earth_are_refused():
    with pytest.raises(ValueError, match="latitude"):
        airlight.sun_position("now", 91, 0)
