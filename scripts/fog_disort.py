"""Radiance inside a slab of fog by PythonicDISORT and its source function, for the scripts that write the reference tables
of fog.

Angles are in radians; cosines `mu` of view directions are positive upwards; depths are measured from the top.
"""

import numpy as np
from PythonicDISORT import pydisort


class Slab:
    """A solved slab under a sun of unit irradiance or, if sun_zenith is None, a uniform sky of unit radiance."""

    def __init__(self, omega, tau, sun_zenith, albedo, moments, phase, axial=False):
        """`moments` are those of the phase function up to the number of streams, `phase(cosine)` is the function; `axial` if
        the light does not depend on azimuth."""
        self.omega, self.tau, self.phase = omega, tau, phase
        self.streams = len(moments) - 1
        self.sun = 0.0 if sun_zenith is None else 1.0
        self.sun_cosine = 0.5 if sun_zenith is None else np.cos(sun_zenith)
        self.sky = 1.0 - self.sun
        self.albedo = albedo
        streams, peak = self.streams, moments[-1]
        angles, _, down, axial_field, *field = pydisort(
            np.array([tau]),
            np.array([omega]),
            streams,
            moments[None, :-1],
            self.sun_cosine,
            self.sun,
            0.0,
            b_neg=self.sky,
            f_arr=np.array([peak]),
            BDRF_Fourier_modes=[albedo] if albedo > 0.0 else [],
            NFourier=1 if axial else streams,
        )
        self.irradiance = float(sum(np.squeeze(part) for part in down(tau)))
        self.azimuth = np.linspace(0.0, np.pi, streams + 1)
        self.azimuth_weight = np.full(streams + 1, np.pi / streams)
        self.azimuth_weight[[0, -1]] /= 2.0
        if axial:
            self.field = lambda depth: np.repeat(axial_field(depth)[:, :, None], streams + 1, axis=2)
        else:
            self.field = lambda depth: field[0](depth, self.azimuth)
        nodes, weights = np.polynomial.legendre.leggauss(streams // 2)
        nodes, weights = (nodes + 1.0) / 2.0, weights / 2.0
        self.angle_weight = weights[np.argmin(np.abs(np.abs(angles)[:, None] - nodes), axis=1)]
        self.depth_scale = 1.0 - omega * peak
        self.truncated = omega * (moments[:-1] - peak) * (2.0 * np.arange(streams) + 1.0) / (4.0 * np.pi)
        self.cosine = -angles  # of the direction of light, positive downwards

    def from_sun(self, mu, azimuth):
        """Cosine of the angle between a view and the sun."""
        across = np.sqrt(1.0 - mu * mu) * np.sqrt(1.0 - self.sun_cosine**2)
        return np.clip(mu * self.sun_cosine + across * np.cos(azimuth), -1.0, 1.0)

    def source(self, depth, radiance, mu, azimuth):
        """Return the source function in a view direction, per unit optical depth, for `radiance = field(depth)` and the sun."""
        sine, mu_sine = np.sqrt(1.0 - self.cosine**2), np.sqrt(1.0 - mu * mu)
        kernel = 0.0
        for side in (1.0, -1.0):
            between = self.cosine[:, None] * mu + sine[:, None] * mu_sine * np.cos(azimuth - side * self.azimuth)
            kernel = kernel + np.polynomial.legendre.legval(np.clip(between, -1.0, 1.0), self.truncated)
        source = np.einsum("mp,mtp,m,p->t", kernel, radiance, self.angle_weight, self.azimuth_weight)
        once = self.sun * self.omega * self.phase(self.from_sun(mu, azimuth))
        return source + once * np.exp(-self.depth_scale * depth / self.sun_cosine)

    def to_the_edge(self, views):
        """Yield the radiance scattered into each view (fraction of tau above the eye, zenith angle, azimuth) up to the edge of the
        fog."""
        depth, depth_weight = depth_nodes(self.tau)
        radiance = self.field(depth)
        for above, zenith, azimuth in views:
            mu = np.cos(zenith)
            source = self.source(depth, radiance, mu, azimuth)
            path = (above * self.tau - depth) / mu
            ahead = path > 0.0
            weight = np.where(ahead, depth_weight / abs(mu), 0.0)
            scattered = np.sum(weight * source * np.exp(-self.depth_scale * np.where(ahead, path, 0.0)))
            # Light from beyond the fog that delta-M scaling counts as transmitted although it was scattered.
            full = (above * self.tau if mu > 0.0 else (above - 1.0) * self.tau) / mu
            beyond = self.sky if mu > 0.0 else self.albedo * self.irradiance / np.pi
            yield scattered + (np.exp(-self.depth_scale * full) - np.exp(-full)) * beyond


def depth_nodes(tau):
    """Return Gauss-Legendre nodes and weights in depth, dense at the boundaries and on both sides of the middle."""
    edges = [0.0, tau / 2.0, tau]
    offsets = (0.03, 0.1, 0.25, 0.5, 1.0, 2.0, 3.5, 5.0, 7.5, 10.0, 15.0, 20.0, 30.0)
    for start, sign in ((0.0, 1.0), (tau, -1.0), (tau / 2.0, 1.0), (tau / 2.0, -1.0)):
        for offset in offsets:
            edge = start + sign * offset
            if 0.0 < edge < tau and min(abs(edge - other) for other in edges) > 1e-3 * min(tau, 10.0):
                edges.append(edge)
    return gauss(np.array(sorted(edges)))


def gauss(edges):
    """Return eight Gauss-Legendre nodes and weights between neighbouring edges."""
    x, w = np.polynomial.legendre.leggauss(8)
    half = np.diff(edges)[:, None] / 2.0
    middle = (edges[:-1, None] + edges[1:, None]) / 2.0
    return (middle + half * x).ravel(), (half * w).ravel()


def henyey_greenstein(g, cosine):
    return (1.0 - g * g) / (4.0 * np.pi) / (1.0 + g * g - 2.0 * g * cosine) ** 1.5
