#!/usr/bin/python3
"""Spectral radius of generalised-alpha with the exponential update of internal variables (docs/theory, section 3.7):

    studies/relaxation_stability.py

An oscillator of the frequency omega with one Maxwell branch, u'' + omega^2 (u - g z) = 0, z' = (u - z)/tau, over steps
omega dt from 1e-5 to 1e5 and dt/tau from 1e-12 to 1e8. Prints for each rho_inf the largest radius less 1 and where it is.
"""
import math

import numpy as np

GRID = 81  # values of each axis
MODULI = (0.01, 0.1, 0.5, 0.9, 0.99, 0.9999)


def radius(omega_dt, h, g, rho_inf):
    """Of the matrix that takes (u, v dt, a dt^2, z) from one step to the next; h = dt/tau."""
    alpha_m, alpha_f = (2 - rho_inf) / (1 + rho_inf), 1 / (1 + rho_inf)
    lag = alpha_m - alpha_f
    gamma, beta = 0.5 + lag, (1 + lag) ** 2 / 4
    e = math.exp(-h)
    c = 1 + math.expm1(-h) / h if h > 1e-4 else h / 2 - h * h / 6
    k = omega_dt ** 2
    u, a, z = np.eye(4)[[0, 2, 3]]
    # Ends of the step without the new acceleration A: U = u_1 + beta A, V = v_1 + gamma A, Z = z_1 + c beta A.
    u_1, v_1 = np.array([1, 1, 0.5 - beta, 0]), np.array([0, 1, 1 - gamma, 0])
    z_1 = e * z + (1 - e - c) * u + c * u_1
    inertia = alpha_m + k * alpha_f * beta * (1 - g * c)
    A = -((1 - alpha_m) * a + k * (alpha_f * (u_1 - g * z_1) + (1 - alpha_f) * (u - g * z))) / inertia
    return max(abs(np.linalg.eigvals(np.array([u_1 + beta * A, v_1 + gamma * A, A, z_1 + c * beta * A]))))


def main():
    for rho_inf in (0, 0.3, 0.5, 0.8, 0.9, 1):
        worst = max((radius(w, h, g, rho_inf) - 1, w, h, g) for w in np.logspace(-5, 5, GRID)
                    for h in np.logspace(-12, 8, GRID) for g in MODULI)
        print("rho_inf %.1f: largest radius 1 + %.1e, at omega dt = %.2e, dt/tau = %.2e, g = %g" % (rho_inf, *worst))


if __name__ == "__main__":
    main()
