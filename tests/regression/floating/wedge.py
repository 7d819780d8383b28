#!/usr/bin/env python3
"""The similarity solution of a wedge that enters calm water with constant speed, without gravity
(Dobrovol'skaya 1969): force, pressure and wetted length.

    tests/regression/floating/wedge.py      # prints the forces beside published ones

Needs numpy. Lengths are over V t, velocities over V, pressures over rho V^2.
"""

import numpy as np


def solve(deadrise, spacing=0.2, rounds=30, turn=None):
    """A dictionary: `force`, F/(rho V^3 t); `pressure`, the largest; `wetted`, length of a face
    over V t; `contact`, the angle between face and surface, degrees; `change` of the last round.

    Half of the flow is mapped to the upper half plane: the axis below the tip to the negative
    numbers, the face to (0, 1), the free surface to (1, inf). With the complex velocity w, dw dz has
    a constant argument along each of the three, so Wagner's function, the integral of
    sqrt(dw dz), maps to a triangle, and w' z' = B t^-1 (1 - t)^(-3/2) but for a constant argument.
    The free surface turns by g against the face; z' follows from the arguments along the real line.
    Velocity less position is along the surface, and as long as the arc s from the contact point:
    g' = -|w'|/s.
    """
    alpha = np.pi / 2 - np.radians(deadrise)  # half the angle of the wedge
    far = np.pi / 2 - alpha                   # g at infinity; at the contact it is pi - contact
    x = np.arange(-40, 12, spacing)           # t = 1 + e^x on the surface
    u = np.exp(x)
    y = np.arange(-40, 40, spacing)           # t/(1 - t) = e^y on the face
    face, rest = 1 / (1 + np.exp(-y)), 1 / (1 + np.exp(y))
    dt_face, dt = face * rest * spacing, u * spacing
    on_surface = np.log(np.abs(u[None, :] - u[:, None]) + (u[:, None] == u[None, :]))
    np.fill_diagonal(on_surface, x + np.log(spacing / (2 * np.pi)))  # for a sum of equal steps
    on_surface -= np.log1p(u)
    on_face = np.log(u[None, :] + rest[:, None]) - np.log1p(u)

    def size(kernel, t, log_gap, turn, start):
        """|z'| from the argument of z', by Cauchy's integral over the logarithm."""
        return np.exp(-alpha / np.pi * np.log(t) - (start * log_gap - kernel @ turn) / np.pi)

    def step(turn):
        """log of what the turns should be by g' = -|w'|/s, less log turn; and the flow."""
        start = far + turn.sum()
        small = 1 - start / np.pi             # contact angle over pi
        z = size(on_surface, 1 + u, x, turn, start)
        z_face = size(on_face, face, np.log(rest), turn, start)
        speed = 1 / (face * rest**1.5 * z_face)
        # Along the face positions and velocities have gone equally far at the contact point.
        b = ((z_face * dt_face).sum() + z_face[-1] * rest[-1] / small) / (
            (speed * dt_face).sum() + speed[-1] * rest[-1] / (0.5 - small))
        s = np.cumsum(z * dt) - 0.5 * z * dt + z[0] * u[0] / small
        new = b / ((1 + u) * u**1.5 * z * s) * dt
        return np.log(new) - np.log(turn), (start, small, z_face, speed, b)

    def solved(turn):
        """Newton's method in the logarithms of the turns."""
        for _ in range(rounds):
            wrong = step(turn)[0]
            change = np.abs(wrong).max()
            if change < 1e-9:
                break
            jacobian = np.array([(step(turn * np.exp(1e-6 * e))[0] - wrong) / 1e-6
                                 for e in np.eye(len(turn))]).T
            move, share = np.linalg.solve(jacobian, -wrong), 1.0
            while True:
                next_turn = turn * np.exp(share * move)
                if far + next_turn.sum() < 0.9999 * np.pi and (
                        np.abs(step(next_turn)[0]).max() < change or share < 0.01):
                    break
                share /= 2
            turn = next_turn
        return turn, change

    if turn is None:
        turn = np.exp(0.4 * x) / (1 + u) ** 2.9  # -g' dt of each cell
        turn *= (0.9 * np.pi - far) / turn.sum()
    turn, change = solved(turn)
    start, small, z_face, speed, b = step(turn)[1]

    # The scale: from infinity to the tip, along the axis, the velocity goes from 0 to V.
    axis = np.exp(y)
    on_axis = np.log(u[None, :] + 1 + axis[:, None]) - np.log1p(u)
    z_axis = size(on_axis, axis, np.log1p(axis), turn, start)
    scale = 1 / (b * spacing / ((1 + axis) ** 1.5 * z_axis)).sum()
    l = np.cumsum(z_face * dt_face) - 0.5 * z_face * dt_face
    q = b * (np.cumsum(speed * dt_face) - 0.5 * speed * dt_face)
    end = l[-1] + z_face[-1] * rest[-1] / small
    # Along the face p' = (l - q) q'; p is 0 at the contact point.
    slope = b * speed * dt_face * (q - l)
    force = 2 * np.sin(alpha) * (l * slope).sum() * scale**3
    pressure = np.cumsum(slope[::-1])[::-1].max() * scale**2
    return {"deadrise": deadrise, "force": force, "pressure": pressure, "wetted": end * scale,
            "contact": 180 * small, "change": change, "scale": scale, "turn": turn}


def main():
    # Table of Zhao & Faltinsen 1993 (J. Fluid Mech. 246, 593-612); their pressure is 2p/rho V^2.
    published = {20: (42.485, 17.774), 30: (14.139, 6.927), 40: (5.477, 3.266)}
    for angle in (20, 30, 40, 45, 60):
        found = solve(angle)
        print(f"{angle} degrees: force {found['force']:.3f}, largest pressure coefficient "
              f"{2 * found['pressure']:.3f}, contact angle {found['contact']:.2f}; published:",
              *published.get(angle, ("-",)))


if __name__ == "__main__":
    main()
