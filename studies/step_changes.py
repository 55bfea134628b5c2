#!/usr/bin/env python3
"""Looks for sequences of steps with which generalised-alpha makes energy (docs/theory, section 8.3).

An undamped vibration of frequency 1 is integrated with steps that change by up to a given ratio: at random, by turns, at
random times, and so that the energy is largest one or two steps later. Prints the largest growth of the amplitude in a
step and the mean step (times the frequency) at which it occurs; a dot where nothing grows beyond what the change of
phase between start and end can feign.
"""
import numpy as np

RADII, RATIOS = (0, 0.5, 0.8, 0.95, 1), (1.1, 1.5, 2, 4, 10)
KINDS = ("random", "turns", "walk", "one ahead", "two ahead")
MEAN_STEPS = np.repeat(np.logspace(-2, 2.5, 24), 10)
RANGE = 8  # steps stay within this factor of their mean


def step(state, dt, before, rho):
    """(U, V, A, A at the start) after a step dt that follows one of `before`: Eqs. (8.1) to (8.3) and (8.8)."""
    alpha_m, alpha_f = (2 - rho) / (1 + rho), 1 / (1 + rho)
    lag = alpha_m - alpha_f
    beta, gamma = (1 + lag) ** 2 / 4, 0.5 + lag
    U, V, end, start = state
    A = end - np.minimum(1, lag * (dt / before - 1)) * (end - start)
    guess = U + dt * V + dt**2 * (0.5 - beta) * A
    new = -((1 - alpha_m) * A + (1 - alpha_f) * U + alpha_f * guess) / (alpha_m + alpha_f * beta * dt**2)
    return np.array([guess + dt**2 * beta * new, V + dt * ((1 - gamma) * A + gamma * new), new, A])


def energy(state):
    return state[0] ** 2 + state[1] ** 2


def ahead(state, dt, rho, ratio, depth):
    """The largest energy that a state can have `depth` steps later."""
    if depth == 0:
        return energy(state)
    return np.max([ahead(step(state, limited(dt * r), dt, rho), limited(dt * r), rho, ratio, depth - 1)
                   for r in (1 / ratio, 1, ratio)], axis=0)


def limited(dt):
    return np.clip(dt, MEAN_STEPS / RANGE, MEAN_STEPS * RANGE)


def greedy(state, dt, rho, ratio, depth):
    trials = [limited(dt * r) for r in (1 / ratio, 1, ratio)]
    gains = [ahead(step(state, trial, dt, rho), trial, rho, ratio, depth) for trial in trials]
    return np.choose(np.argmax(gains, axis=0), trials)


def next_step(kind, k, state, dt, rho, ratio, rng):
    if kind == "random":
        return limited(dt * ratio ** rng.uniform(-1, 1, dt.size))
    if kind == "turns":
        return limited(dt * ratio ** (1 if k % 2 else -1))
    if kind == "walk":
        return limited(dt * ratio ** rng.choice([-1.0, 0, 0, 0, 1], dt.size))
    return greedy(state, dt, rho, ratio, ("one ahead", "two ahead").index(kind))


def growth(kind, rho, ratio, rng, count):
    """Largest growth of the logarithm of the amplitude in a step, and the mean step with it."""
    dt, scale = MEAN_STEPS.copy(), np.zeros(MEAN_STEPS.size)
    state = rng.normal(size=(4, dt.size))
    state[2:] = -state[0]
    for k in range(count):
        if k == count // 4:
            first = scale + np.log(energy(state)) / 2
        new = next_step(kind, k, state, dt, rho, ratio, rng)
        state, dt = step(state, new, dt, rho), new
        size = np.maximum(np.abs(state).max(axis=0), 1e-300)
        state, scale = state / size, scale + np.log(size)
    with np.errstate(divide="ignore"):
        mean = (scale + np.log(energy(state)) / 2 - first) / (count - count // 4)
    return mean.max(), MEAN_STEPS[mean.argmax()]


def main():
    rng = np.random.default_rng(1)
    for rho in RADII:
        for ratio in RATIOS:
            cells = []
            for kind in KINDS:
                count = 800 if "ahead" in kind else 8000
                most, at = growth(kind, rho, ratio, rng, count)
                cells.append(f"{most:.0e} at {at:.2g}" if most > 2 / count else ".")
            print(f"rho_inf {rho:<5} ratio {ratio:<4}", *(f"{k}: {c};" for k, c in zip(KINDS, cells)), flush=True)


if __name__ == "__main__":
    main()
