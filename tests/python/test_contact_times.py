"""Contacts of balls against all pairs in NumPy, which share no code with the library."""

import unittest

import kds
import numpy as np

# Both ways solve a quadratic equation in doubles. The roots differ by roundings of its coefficients, some 1e-15 of
# the numbers of order 10 in it, divided by the slope at the root; and a pair is only compared where the discriminant
# is beyond `clear`, so that the slope is at least of the order 0.01. So they agree to far better than 1e-9 s; an error in
# a coefficient of any kind would show in the first digits.
TIME_ERROR = 1e-9
CLEAR = 1e-3


def first_times(positions, velocities, radii, end):
    """Of each pair (a, b, time) the first time in (0, end] at which the distance is that of touching; of pairs apart at 0.

    Pairs that nearly touch or nearly miss come second: of them nothing is said.
    """
    a, b = np.triu_indices(len(positions), 1)
    x = positions[b] - positions[a]
    v = velocities[b] - velocities[a]
    sum_of_radii = radii[a] + radii[b]
    square, half, rest = (v * v).sum(1), (x * v).sum(1), (x * x).sum(1) - sum_of_radii * sum_of_radii
    discriminant = half * half - square * rest
    with np.errstate(invalid="ignore"):
        time = (-half - np.sqrt(discriminant)) / square
    meets = (rest > 0) & (discriminant > CLEAR) & (half < 0) & (time < end)
    unclear = (np.abs(discriminant) <= CLEAR) | (np.abs(time - end) < 1e-6) | (np.abs(rest) < 1e-6) | (rest <= 0)
    meets &= ~unclear
    return (
        {(int(i), int(j)): t for i, j, t in zip(a[meets], b[meets], time[meets])},
        set(zip(a[unclear].tolist(), b[unclear].tolist())),
    )


class BruteForce(unittest.TestCase):
    def test_random_balls(self):
        for seed in range(8):
            with self.subTest(seed=seed):
                random = np.random.default_rng(seed)
                n, end = 150, 2.0
                positions = random.uniform(0, 8, (n, 3))
                velocities = random.normal(0, 1, (n, 3))
                radii = random.uniform(0.1, 0.5, n)
                world = kds.World(response="none")
                ids = world.add_bodies(None, positions, velocities, radii=radii)
                self.assertEqual(ids.tolist(), list(range(n)))
                events = world.advance_to(end)
                contacts = events[events.kind == kds.EventKind.CONTACT]
                self.assertTrue((np.diff(events.time) >= 0).all())
                expected, unclear = first_times(positions, velocities, radii, end)
                found = {(int(e.a), int(e.b)): e for e in contacts if (int(e.a), int(e.b)) not in unclear}
                self.assertGreater(len(expected), 20)
                self.assertEqual(found.keys(), expected.keys())
                for (a, b), event in found.items():
                    self.assertLess(abs(event.time - expected[a, b]), TIME_ERROR)
                    centres = positions + velocities * event.time
                    normal = centres[b] - centres[a]
                    normal /= np.linalg.norm(normal)
                    self.assertLess(np.abs(event.normal - normal).max(), 1e-6)
                    self.assertLess(np.abs(event.point - (centres[a] + radii[a] * normal)).max(), 1e-6)

    def test_falling_ball(self):
        world = kds.World(degree=2)
        world.add_body(kds.sphere(0.5), (0, 0, 10), acceleration=(0, 0, -10))
        world.add_body(kds.sphere(0.5), (0, 0, 0), fixed=True)
        (event, *_) = world.advance_to(3)
        self.assertAlmostEqual(event.time, np.sqrt(2 * 9 / 10), places=14)


if __name__ == "__main__":
    unittest.main()
