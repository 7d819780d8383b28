#!/usr/bin/env python3
"""Linear theory of a floating box.

`Box` solves the radiation problem of a rectangular section that heaves in water of finite depth by
matched eigenfunction expansions (as Yeung 1981 and Lee 1995 do), and has the exciting force by
Haskind's relation. `decay()` is the motion of the section after a release (Cummins 1962).

    tests/regression/floating/theory.py     # prints the checks

Needs numpy. SI units, per metre of width; time factors are exp(-i w t).
"""

import numpy as np

G, RHO = 9.81, 1000.0


def wave_number(omega, depth):
    """k of omega^2 = g k tanh(k depth), 1/m."""
    k = omega**2 / G / np.sqrt(np.tanh(omega**2 * depth / G))
    for _ in range(50):
        t = np.tanh(k * depth)
        k -= (G * k * t - omega**2) / (G * t + G * k * depth * (1 - t * t))
    return k


def evanescent(omega, depth, count):
    """The positive roots of omega^2 = -g k tan(k depth)."""
    nu = omega**2 * depth / G
    m = np.arange(1, count + 1) * np.pi
    low, high = m - np.pi / 2, m.copy()  # x tan x + nu changes its sign once in between
    for _ in range(60):
        x = (low + high) / 2
        below = x * np.tan(x) + nu < 0
        low, high = np.where(below, x, low), np.where(below, high, x)
    return (low + high) / 2 / depth


def group_speed(omega, depth):
    k = wave_number(omega, depth)
    return omega / k * (0.5 + k * depth / np.sinh(2 * k * depth))


class Box:
    """A section of this beam and draft in water of this depth, m."""

    def __init__(self, beam, draft, depth, terms=60):
        self.a, self.draft, self.depth, self.terms = beam / 2, draft, depth, terms
        self.gap = depth - draft

    def heave(self, omega):
        """Added mass, kg/m, damping, kg/(m s), and the amplitude of the waves over the velocity of
        the box, s (complex)."""
        a, s, h, n = self.a, self.gap, self.depth, self.terms
        outer = round(n * h / s)  # as fine outside as under the box
        k0, km = wave_number(omega, h), evanescent(omega, h, outer)
        # Orthonormal functions of the height over the floor outside, and their integrals with
        # cos(mu y) under the box.
        k = np.concatenate([[1j * k0], km])
        deep = k0 * h > 30  # cosh would overflow: exp(k (y - h)) instead
        if deep:
            k[0] = 1j
        mu = np.arange(n) * np.pi / s
        norm = np.sqrt(h / 2 + np.sin(2 * k * h) / (4 * k))
        u, v = k[None, :], mu[:, None]
        c = np.where(np.abs(u - v) * s < 1e-9, s / 2,
                     0.5 * (np.sinc((u - v) * s / np.pi) + np.sinc((u + v) * s / np.pi)) * s)
        c = c / norm
        if deep:  # the wave hardly reaches below the box
            k[0], norm[0] = 1j * k0, 1
            c[:, 0] = np.sqrt(2 * k0) * np.exp(k0 * (s - h)) * k0 * (-1.0) ** np.arange(n) / (
                k0**2 + mu**2)
        # Under the box: (y^2 - x^2)/2s + sum A cosh(mu x)/cosh(mu a) cos(mu y). Outside: sum B f(y)
        # exp(-kappa (x - a)). Fluxes are equal in the mean with every f, potentials with every cos.
        kappa = k.copy()
        kappa[0] = -1j * k0
        flux = (mu * np.tanh(mu * a))[:, None] * c
        share = np.where(np.arange(n) == 0, s, s / 2)
        sign = (-1.0) ** np.arange(n)
        inner = np.empty(n)  # integrals of the particular solution at x = a with every cos
        inner[0] = s * s / 6 - a * a / 2
        inner[1:] = sign[1:] / mu[1:] ** 2
        particular = -(a / s) * c[0]
        matrix = np.diag(share).astype(complex) + (c / kappa) @ flux.T
        amplitude = np.linalg.solve(matrix, -inner - (c / kappa) @ particular)
        outside = -(particular + amplitude @ flux) / kappa
        force = a * s - a**3 / (3 * s) + 2 * a * amplitude[0]
        force += (amplitude[1:] * sign[1:] * 2 * np.tanh(mu[1:] * a) / mu[1:]).sum()
        top = np.sqrt(2 * k0) if deep else np.cos(k[0] * h) / norm[0]
        wave = 1j * omega / G * outside[0] * top
        return RHO * force.real, RHO * omega * force.imag, wave

    def exciting(self, omega):
        """Amplitude of the heave force of a wave over its amplitude, N/m^2 (Haskind)."""
        return 2 * RHO * G * group_speed(omega, self.depth) * abs(self.heave(omega)[2])

    def response(self, omega):
        """Heave amplitude of the floating box over the wave amplitude."""
        added, damping, _ = self.heave(omega)
        mass, spring = RHO * 2 * self.a * self.draft, RHO * G * 2 * self.a
        return self.exciting(omega) / abs(spring - omega**2 * (mass + added) - 1j * omega * damping)

    def decay(self, times, start=1.0):
        """Heave at these times after a release at `start` in calm water. The transform of the
        velocity is known for all frequencies; its real part has an even continuation."""
        mass, spring = RHO * 2 * self.a * self.draft, RHO * G * 2 * self.a
        top = 12 * np.sqrt(G / self.draft)
        w = top * (np.arange(1, 601) / 600) ** 2  # denser where the response varies
        coarse = [self.heave(x)[:2] for x in w[::2]]
        added, damping = (np.interp(w, w[::2], column) for column in np.array(coarse).T)
        fine = np.linspace(w[0], top, 40001)
        added, damping = np.interp(fine, w, added), np.interp(fine, w, damping)
        v = -spring * start / (spring - fine**2 * (mass + added) - 1j * fine * damping)
        dw = fine[1] - fine[0]
        weight = np.full(len(fine), dw)
        weight[[0, -1]] = dw / 2
        weight[0] += fine[0]  # below the first frequency
        return start + np.array([(weight * v.real * np.sin(fine * t) / fine).sum()
                                 for t in np.atleast_1d(times)]) * 2 / np.pi


def main():
    print("omega  added mass / displaced mass  damping / that of the waves - 1  force / rho g beam"
          "  response  change by twice the terms")
    for omega in (0.01, 3, 7, 10, 15):
        box, finer = Box(0.2, 0.1, 0.4), Box(0.2, 0.1, 0.4, 120)
        added, damping, wave = box.heave(omega)
        radiated = 2 * RHO * G * group_speed(omega, 0.4) * abs(wave) ** 2
        changes = [abs(x / y - 1) for x, y in zip(box.heave(omega)[:2], finer.heave(omega)[:2])]
        print(f"{omega:5}  {added / (RHO * 0.02):.4f}  {damping / radiated - 1:.1e}  "
              f"{box.exciting(omega) / (RHO * G * 0.2):.4f}  {box.response(omega):.4f}  "
              f"{max(changes):.1e}")


if __name__ == "__main__":
    main()
