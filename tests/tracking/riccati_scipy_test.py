"""The Riccati solution of the feedback design against SciPy, on the linearised system that print_design prints.

Backwards from the last sample of each phase, SciPy integrates -S' = A'S + S A - S B R⁻¹ B' S + Q with the coefficients of the
grid (mean of both ends of a step) by an adaptive Runge-Kutta method of order 8, and solves the algebraic equation at the end
by Schur vectors. Both share nothing with Prowl's doubling and matrix exponentials.
"""

import subprocess
import sys
import unittest

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import solve_continuous_are

PROGRAM = sys.argv.pop(1)
TOLERANCE = 1e-6


class Sample:
    def __init__(self, line):
        numbers = np.array(line.split(), dtype=float)
        self.phase, self.sample = int(numbers[0]), int(numbers[1])
        self.step, n, nu = numbers[2], int(numbers[3]), int(numbers[4])
        rest = numbers[5:]
        self.r_inverse, rest = rest[:nu], rest[nu:]
        self.A, rest = rest[: n * n].reshape(n, n), rest[n * n :]
        self.B, rest = rest[: n * nu].reshape(n, nu), rest[n * nu :]
        self.Q, rest = rest[: n * n].reshape(n, n), rest[n * n :]
        self.S = rest.reshape(n, n)


def design(task, samples):
    """Samples of the design by phase, in order of time."""
    run = subprocess.run([PROGRAM, task, str(samples)], check=True, capture_output=True, text=True)
    phases = {}
    for line in run.stdout.splitlines():
        sample = Sample(line)
        phases.setdefault(sample.phase, []).insert(0, sample)
    return phases


def step_back(left, right, S):
    n = len(S)
    A, B, Q = (left.A + right.A) / 2, (left.B + right.B) / 2, (left.Q + right.Q) / 2
    G = B @ np.diag(left.r_inverse) @ B.T

    def rate(_, flat):
        S = flat.reshape(n, n)
        return (A.T @ S + S @ A - S @ G @ S + Q).ravel()

    return solve_ivp(rate, (0, left.step), S.ravel(), method="DOP853", rtol=1e-11, atol=1e-13).y[:, -1].reshape(n, n)


class RiccatiAgainstScipy(unittest.TestCase):
    def check(self, task, samples, directions):
        phases = design(task, samples)
        compared = 0
        for phase in phases.values():
            S = phase[-1].S
            for left, right in zip(phase[-2::-1], phase[::-1]):
                self.assertEqual(left.sample + 1, right.sample)
                S = step_back(left, right, S)
                error = np.abs(S - left.S).max() / np.abs(S).max()
                self.assertLess(error, TOLERANCE, f"{task}, phase {left.phase}, sample {left.sample}")
                compared += 1
        end = phases[max(phases)][-1]
        self.assertEqual(directions, len(end.S))
        stationary = solve_continuous_are(end.A, end.B, end.Q, np.diag(1 / end.r_inverse))
        self.assertLess(np.abs(end.S - stationary).max() / np.abs(stationary).max(), TOLERANCE, f"{task}, end")
        print(f"{task}: {len(phases)} phases, {compared} steps, {directions} directions at the end")
        self.assertGreater(compared, 20)

    def test_independent_contacts(self):
        self.check("hyq/stand", 2000, 12)

    def test_contacts_that_open_and_land(self):
        self.check("hyq/balance", 300, 12)

    def test_redundant_contacts_knees(self):
        self.check("hyq/kneel", 400, 6)

    def test_redundant_contacts_flat_feet(self):
        self.check("talos/squat", 40, 52)


if __name__ == "__main__":
    unittest.main()
