#!/usr/bin/env python3
"""Write the reference table of Mie efficiencies for the tests of the crate `airlight` (miepython 3.3.0, mpmath 1.3.0).

    python3 scripts/mie_reference.py > crates/airlight/tests/data/mie_corners.csv

Extreme cases: spheres much smaller and much larger than the wavelength, metals, soot, weakly absorbing water. Each sphere by
`mpmath` with 60 digits, from the plain formulas of Bohren and Huffman (1983, eqs. 4.53, 4.61, 4.62, and sec. 4.5), and by
miepython. The index is n + i k. Amplitudes at 0, 60, 137 and 180 degrees are by mpmath.
"""

import sys

import miepython
from mpmath import mp, mpc, mpf

mp.dps = 60

SPHERES = [
    (1e-3, 1.5, 0.0),
    (1e-3, 1.5, 1.0),
    (1e-3, 1.75, 0.44),
    (1e-3, 10.0, 10.0),
    (0.05, 1.333, 1e-8),
    (0.3, 1.5, 0.01),
    (1.0, 1.55, 0.0),
    (3.0, 1.75, 0.44),
    (5.21282, 1.55, 0.0),
    (10.0, 1.5, 0.0),
    (10.0, 10.0, 10.0),
    (100.0, 1.333, 1e-8),
    (100.0, 1.5, 1.0),
    (1000.0, 1.5, 0.1),
    (1000.0, 1.5, 1.0),
    (1000.0, 0.75, 0.0),
    (20000.0, 1.333, 0.0),
    (20000.0, 1.5, 1.0),
]
ANGLES = (0, 60, 137, 180)


def sphere(x, n, k):
    """Return efficiencies and amplitudes with 60 digits."""
    x, m = mpf(x), mpc(n, k)
    last = int(x + 8 * x ** (mpf(1) / 3) + 12)
    z = m * x
    d = {}
    value = mpc(0)
    for order in range(max(last, int(abs(z) + 20 * abs(z) ** (mpf(1) / 3))) + 60, 0, -1):
        value = order / z - 1 / (value + order / z)
        if order - 1 <= last:
            d[order - 1] = value
    psi_before, psi = mp.cos(x), mp.sin(x)
    chi_before, chi = -mp.sin(x), mp.cos(x)
    mus = [mp.cos(mp.radians(angle)) for angle in ANGLES]
    pis = [(mpf(0), mpf(1)) for _ in ANGLES]
    amplitudes = [[mpc(0), mpc(0)] for _ in ANGLES]
    scattered = extinct = interference = mpf(0)
    back = mpc(0)
    previous = None
    for order in range(1, last + 1):
        psi_before, psi = psi, (2 * order - 1) / x * psi - psi_before
        chi_before, chi = chi, (2 * order - 1) / x * chi - chi_before
        xi_before, xi = mpc(psi_before, -chi_before), mpc(psi, -chi)
        inside = d[order] / m + order / x
        a = (inside * psi - psi_before) / (inside * xi - xi_before)
        inside = d[order] * m + order / x
        b = (inside * psi - psi_before) / (inside * xi - xi_before)
        weight = 2 * order + 1
        scattered += weight * (abs(a) ** 2 + abs(b) ** 2)
        extinct += weight * (a + b).real
        back += weight * (-1) ** order * (a - b)
        interference += mpf(weight) / (order * (order + 1)) * (a * mp.conj(b)).real
        if previous:
            interference += mpf((order - 1) * (order + 1)) / order * (
                previous[0] * mp.conj(a) + previous[1] * mp.conj(b)
            ).real
        previous = (a, b)
        for i, mu in enumerate(mus):
            before, now = pis[i]
            tau = order * mu * now - (order + 1) * before
            factor = mpf(weight) / (order * (order + 1))
            amplitudes[i][0] += factor * (a * now + b * tau)
            amplitudes[i][1] += factor * (a * tau + b * now)
            pis[i] = (now, (weight * mu * now - (order + 1) * before) / order)
    scale = 2 / x**2
    values = [scale * extinct, scale * scattered, scale * (extinct - scattered)]
    values += [abs(back) ** 2 / x**2, 2 * interference / scattered]
    for pair in amplitudes:
        values += [part for s in pair for part in (s.real, s.imag)]
    return values


def main():
    out = sys.stdout
    out.write(
        "# Efficiencies and amplitudes of spheres in extreme cases, index n + i k: by mpmath with 60 digits, and by miepython\n"
        "# (whose rows end after g). Backscattering over x^2. Made by scripts/mie_reference.py\n"
    )
    names = [f"{s}_{part}_{angle}" for angle in ANGLES for s in ("S1", "S2") for part in ("re", "im")]
    out.write("source,x,n,k,Qext,Qsca,Qabs,Qback,g," + ",".join(names) + "\n")
    for x, n, k in SPHERES:
        row = ",".join(mp.nstr(value, 15) for value in sphere(x, n, k))
        out.write(f"mpmath,{x:g},{n:g},{k:g},{row}\n")
        ext, sca, back, g = miepython.efficiencies_mx(complex(n, -k), x)
        out.write(f"miepython,{x:g},{n:g},{k:g},{ext:.12g},{sca:.12g},{ext - sca:.12g},{back:.12g},{g:.12g}\n")


if __name__ == "__main__":
    main()
