"""Lorenz-Mie theory and the accuracy report."""

import json
import pathlib

import numpy as np
import pytest

import airlight

DATA = pathlib.Path(__file__).resolve().parents[2] / "airlight/tests/data/mie_water_n1.333_efficiencies.csv"


def test_efficiencies_match_the_reference_table():
    lines = [line for line in DATA.read_text().splitlines() if line and not line.startswith("#")]
    names = lines[0].split(",")
    rows = [dict(zip(names, map(float, line.split(",")), strict=True)) for line in lines[1:]]
    assert rows
    for row in rows:
        extinction, scattering, absorption, back, asymmetry = airlight.mie_sphere(row["x"], 1.333 + 0j)
        assert extinction == pytest.approx(row["Qext"], rel=1e-9)
        assert scattering == pytest.approx(row["Qsca"], rel=1e-9)
        assert back == pytest.approx(row["Qback"], rel=1e-7)
        assert abs(absorption) < 1e-9
        assert asymmetry == pytest.approx(row["g"], rel=1e-5, abs=1e-7)


def test_phase_functions_integrate_to_1():
    nodes, weights = np.polynomial.legendre.leggauss(400)
    angles = np.degrees(np.arccos(nodes))
    assert 2 * np.pi * airlight.mie_phase(20.0, 1.5 + 0.01j, angles) @ weights == pytest.approx(1, rel=1e-9)
    matrix = airlight.Particles(0.5, 0.2).scattering_matrix(550.0, angles)
    assert matrix.shape == (400, 4)
    assert 2 * np.pi * matrix[:, 0] @ weights == pytest.approx(1, rel=1e-4)


def test_droplets_far_larger_than_the_wavelength_remove_twice_the_light_that_falls_on_them():
    bulk = airlight.Particles(20.0, 0.1).bulk([450.0, 650.0])
    area = np.pi * 20.0**2 * (1 - 0.1) * (1 - 2 * 0.1)
    np.testing.assert_allclose(bulk["scattering_um2"] / area, 2.0, rtol=0.05)
    assert (bulk["absorption_um2"] < 1e-3 * bulk["scattering_um2"]).all()


@pytest.mark.parametrize("arguments", [(-1.0, 1.5 + 0j), (10.0, -1 + 0j)])
def test_impossible_spheres_are_refused(arguments):
    with pytest.raises(ValueError, match="expected"):
        airlight.mie_sphere(*arguments)


@pytest.mark.slow
def test_accuracy_report_is_that_of_the_program(program):
    report = airlight.accuracy(["measured"])
    assert report.holds
    assert report.text() == program("accuracy", "measured")
    assert json.loads(report.json())
    assert "<svg" in report._repr_html_()


def test_unknown_comparisons_are_refused():
    with pytest.raises(ValueError, match="expected a set of comparisons"):
        airlight.accuracy(["measurement"])
