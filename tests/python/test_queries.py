"""Questions to a world, against plain formulas and against what happens."""

import unittest

import kds
import numpy as np

# Coordinates are of the order 10, so both sides are off by some 1e-14; of a ray that only grazes a ball more: the root of
# 1e-14 is 1e-7. Another ball is farther away than that by far.
ERROR = 1e-6


def balls(seed, n=300):
    random = np.random.default_rng(seed)
    world = kds.World(response="none")
    positions, radii = random.uniform(0, 10, (n, 3)), random.uniform(0.1, 0.6, n)
    world.add_bodies(None, positions, random.normal(0, 1, (n, 3)), radii=radii)
    world.advance_to(0.5)
    return world, world.positions(), radii, random


class Queries(unittest.TestCase):
    def test_rays(self):
        for seed in range(4):
            with self.subTest(seed=seed):
                world, positions, radii, random = balls(seed)
                hits = 0
                for _ in range(50):
                    start, end = random.uniform(-2, 12, (2, 3))
                    way = end - start
                    x = start - positions
                    a, b, c = way @ way, x @ way, (x * x).sum(1) - radii**2
                    with np.errstate(invalid="ignore"):
                        part = np.where(c < 0, 0.0, (-b - np.sqrt(b * b - a * c)) / a)
                    met = np.flatnonzero((part >= 0) & (part <= 1))
                    hit = world.cast(start, end)
                    self.assertEqual(hit is None, len(met) == 0)
                    every = world.cast_all(start, end)
                    self.assertEqual(set(every.a.tolist()), set(met.tolist()))
                    self.assertTrue((np.diff(every.time) >= 0).all())
                    if hit is None:
                        continue
                    hits += 1
                    first = met[np.argmin(part[met])]
                    self.assertEqual(hit.a, first)
                    self.assertLess(abs(hit.time - part[first]), ERROR)
                    self.assertLess(np.abs(hit.point - (start + way * hit.time)).max(), ERROR)
                    other = world.cast(start, end, filter=lambda body: body != first)
                    self.assertTrue(other is None or other.a != first)
                    self.assertEqual(other is None, len(met) == 1)
                self.assertGreater(hits, 10)

    def test_what_is_where(self):
        world, positions, radii, random = balls(9)
        for _ in range(30):
            place, radius = random.uniform(0, 10, 3), random.uniform(0.2, 2)
            inside = np.flatnonzero(np.linalg.norm(positions - place, axis=1) < radii + radius)
            self.assertEqual(world.overlapping(kds.sphere(radius), place).tolist(), inside.tolist())
            near = np.maximum(np.linalg.norm(positions - place, axis=1) - radii, 0)
            found = world.nearest(place, 7)
            self.assertLess(np.abs(found.distance - np.sort(near)[:7]).max(), ERROR)
            self.assertLess(np.abs(found.distance - near[found.body]).max(), ERROR)
            apart = np.linalg.norm(found.point - place, axis=1)
            self.assertLess(np.abs(apart - found.distance)[found.distance > 0].max(initial=0), ERROR)
            self.assertEqual(found.from_point.tolist(), [list(place)] * len(found))
            near = np.maximum(np.linalg.norm(positions - place, axis=1) - radii - radius, 0)
            found = world.nearest(place, 7, kds.sphere(radius))
            self.assertLess(np.abs(found.distance - np.sort(near)[:7]).max(), ERROR)
            apart = np.linalg.norm(found.point - found.from_point, axis=1)
            self.assertLess(np.abs(apart - found.distance).max(), ERROR)
            low, high = place - radius, place + radius
            near = np.flatnonzero(((positions + radii[:, None] > low) & (positions - radii[:, None] < high)).all(1))
            self.assertEqual(world.in_box(low, high).tolist(), near.tolist())

    def test_the_future_is_what_happens(self):
        world, *_ = balls(4, n=200)
        until = world.now + 20
        foretold = {}
        for body in world.bodies.tolist():
            touched = [int(other) for other in world.bodies if other != body and world.touching(body, other)]
            hit = world.next_contact_of(body, until=until, filter=lambda other: other not in touched)
            if hit is not None:
                foretold[body] = (hit.time, int(hit.a))
                pair = sorted((body, int(hit.a)))
                between = world.next_contact_between(*pair, until=until)
                self.assertEqual(between.time, hit.time)
        touching = {(a, b) for a in world.bodies.tolist() for b in world.bodies.tolist() if a < b and world.touching(a, b)}
        happened = {}
        for event in world.advance_to(until):
            a, b = int(event.a), int(event.b)
            if event.kind == kds.EventKind.CONTACT and (a, b) not in touching and event.time > until - 20:
                happened.setdefault(a, (event.time, b))
                happened.setdefault(b, (event.time, a))
        self.assertGreater(len(foretold), 20)
        self.assertEqual(foretold, happened)

    def test_shapes_that_are_in_no_world(self):
        world = kds.World()
        target = world.add_body(kds.box((1, 1, 1)), (5, 0, 0), (-1, 0, 0))
        hit = world.next_contact(kds.sphere(0.5), (0, 0, 0), (1, 0, 0), until=10)
        self.assertEqual((hit.time, hit.a), (1.75, target))
        self.assertEqual(hit.normal.tolist(), [1, 0, 0])
        self.assertEqual(kds.feature_name(hit.feature_b), "f0")
        self.assertIsNone(world.next_contact(kds.sphere(0.5), (0, 0, 0), (1, 0, 0), until=1.5))
        swept = world.cast((0, 0, 0), (8, 0, 0), kds.sphere(0.5))
        self.assertEqual((swept.time, swept.a), (0.4375, target))

    def test_filters_change_nothing(self):
        world = kds.World()
        ball = world.add_body(kds.sphere(1), (5, 0, 0))

        def refused(body):
            for change in (
                lambda: world.remove_body(ball),
                lambda: world.update_motion(ball, velocity=(1, 0, 0)),
                lambda: world.add_body(kds.sphere(1), (0, 0, 0)),
                lambda: world.advance_to(1),
                lambda: world.next_time,
            ):
                with self.assertRaisesRegex(RuntimeError, "while a filter is at work"):
                    change()
            return world.position(body)[0] == 5

        self.assertEqual(world.cast((0, 0, 0), (9, 0, 0), filter=refused).a, ball)
        with self.assertRaises(ZeroDivisionError):
            world.cast((0, 0, 0), (9, 0, 0), filter=lambda body: 1 / 0)
        world.remove_body(ball)
        self.assertEqual(len(world), 0)

    def test_closest_approach(self):
        world = kds.World()
        a = world.add_body(kds.sphere(0.1), (0, 0, 0), (1, 0, 0))
        b = world.add_body(kds.sphere(0.1), (4, 3, 0), (-1, 0, 0))
        self.assertEqual(world.closest_approach(a, b, until=10), kds.Approach(2.0, 3.0))
        self.assertEqual(world.closest_approach(a, b, until=1).time, 1.0)

    def test_how_far_apart(self):
        world = kds.World()
        a = world.add_body(kds.box((1, 1, 1)), (0, 0, 0))
        b = world.add_body(kds.sphere(0.5), (3, 0, 0))
        found = world.distance_between(a, b)
        self.assertEqual(found.distance, 1.5)
        self.assertEqual((found.of_a.tolist(), found.of_b.tolist()), ([1, 0, 0], [2.5, 0, 0]))


if __name__ == "__main__":
    unittest.main()
