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

    def test_all_that_will_be_met(self):
        world, positions, radii, random = balls(6)
        until, velocities = world.now + 3, world.velocities()
        met_in_all = 0
        for body in range(20):
            hits = world.next_contacts_of(body, until=until, mode="transparent")
            self.assertTrue((np.diff(hits.time) >= 0).all())
            # Those whose centres come nearer than the sum of the radii.
            x, v = positions - positions[body], velocities - velocities[body]
            with np.errstate(invalid="ignore"):
                nearest = np.clip(np.nan_to_num(-(x * v).sum(1) / (v * v).sum(1)), 0, 3)
            apart = np.linalg.norm(x + v * nearest[:, None], axis=1) - radii - radii[body]
            apart[body] = np.inf
            self.assertEqual(sorted(hits.a.tolist()), np.flatnonzero(apart < 0).tolist())
            self.assertGreater(np.abs(apart).min(), ERROR)
            first = world.next_contact_of(body, until=until, mode="transparent")
            self.assertEqual(None if first is None else first.tobytes(), hits[0].tobytes() if len(hits) else None)
            met_in_all += len(hits)
            # The same of a ball that is in no world, beside the one that it is a copy of.
            copy = world.next_contacts(kds.sphere(radii[body]), positions[body], velocities[body], until=until)
            self.assertEqual(sorted(copy.a.tolist()), sorted(hits.a.tolist() + [body]))
            # All that it meets is near its way.
            low, high = positions[body] - radii[body], positions[body] + radii[body]
            near = world.in_moving_box(low, high, velocities[body], until=until)
            self.assertLessEqual(set(copy.a.tolist()), set(near.tolist()))
            self.assertLess(len(near), 300)
        self.assertGreater(met_in_all, 30)
        with self.assertRaisesRegex(ValueError, "mode: must be 'resolved' or 'transparent'"):
            world.next_contact_of(0, until=until, mode="elastic")
        with self.assertRaisesRegex(ValueError, "high: must not be below low"):
            world.in_moving_box((0, 0, 0), (1, -1, 1), until=until)

    def test_all_pairs(self):
        world, positions, radii, random = balls(7)
        a, b = np.triu_indices(300, 1)
        touching = np.linalg.norm(positions[a] - positions[b], axis=1) < radii[a] + radii[b]
        pairs = np.stack([a, b], axis=1)
        self.assertEqual(world.contact_pairs().tolist(), pairs[touching].tolist())
        self.assertGreater(touching.sum(), 20)
        until, velocities = world.now + 2, world.velocities()
        x, v = positions[a] - positions[b], velocities[a] - velocities[b]
        when = np.clip(-(x * v).sum(1) / (v * v).sum(1), 0, 2)
        apart = np.linalg.norm(x + v * when[:, None], axis=1)
        near = world.pairs_nearer_than(0.5, until=until)
        self.assertEqual(near.dtype.names, ("a", "b", "time", "distance"))
        self.assertEqual({(int(p.a), int(p.b)) for p in near}, set(map(tuple, pairs[apart < 0.5].tolist())))
        self.assertGreater(len(near), 50)
        self.assertTrue((np.diff(near.time) >= 0).all())
        for pair in near:
            self.assertEqual(world.closest_approach(pair.a, pair.b, until=until), (pair.time, pair.distance))
        odd = world.pairs_nearer_than(0.5, until=until, filter=lambda body: body % 2 == 1)
        self.assertEqual(odd.tolist(), [pair.tolist() for pair in near if pair.a % 2 == 1 and pair.b % 2 == 1])
        with self.assertRaisesRegex(ValueError, "distance"):
            world.pairs_nearer_than(0, until=until)
        self.assertEqual(kds.World().contact_pairs().shape, (0, 2))

    def test_what_a_sensor_moves_with(self):
        world = kds.World()
        ball = world.add_body(kds.sphere(1), (0, 0, 0))
        alarm = world.attach_sensor(ball, kds.sphere(2))
        self.assertEqual((world.attached_to(alarm), world.attached_to(ball)), (ball, None))

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
        c = world.add_body(kds.sphere(0.1), (4, 3, 0), (-1, 0, 0), start=5)
        with self.assertRaisesRegex(ValueError, f"body {c} enters later, at 5"):
            world.closest_approach(a, c, until=10)
        with self.assertRaisesRegex(ValueError, f"body {c} enters later, at 5"):
            world.distance_between(c, a)

    def test_how_far_apart(self):
        world = kds.World()
        a = world.add_body(kds.box((1, 1, 1)), (0, 0, 0))
        b = world.add_body(kds.sphere(0.5), (3, 0, 0))
        found = world.distance_between(a, b)
        self.assertEqual(found.distance, 1.5)
        self.assertEqual((found.of_a.tolist(), found.of_b.tolist()), ([1, 0, 0], [2.5, 0, 0]))

    def test_how_far_apart_shapes_are_that_are_in_no_world(self):
        random = np.random.default_rng(8)
        for _ in range(50):
            place, radii, q = random.normal(0, 3, 3), random.uniform(0.1, 1, 2), random.normal(0, 1, 4)
            q /= np.linalg.norm(q)
            found = kds.shape_distance(kds.sphere(radii[0]), kds.sphere(radii[1]), place, orientation_b=q)
            self.assertAlmostEqual(found.distance, max(np.linalg.norm(place) - radii.sum(), 0), delta=ERROR)
            # The nearest point of a box is the place, in the axes of the box, cut to its half extents.
            w, x, y, z = q
            axes = np.array([
                [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
            ])  # fmt: skip
            half = random.uniform(0.1, 1, 3)
            nearest = axes @ np.clip(axes.T @ place, -half, half)
            apart = np.linalg.norm(place - nearest)
            if apart < radii[0]:
                continue
            found = kds.shape_distance(kds.box(half), kds.sphere(radii[0]), place, orientation_a=q)
            self.assertAlmostEqual(found.distance, apart - radii[0], delta=ERROR)
            self.assertLess(np.abs(found.of_a - nearest).max(), ERROR)
            self.assertAlmostEqual(np.linalg.norm(found.of_b - found.of_a), found.distance, delta=ERROR)
        sheet = kds.bending_mesh([0, 2], [[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 0, 2], [1, 0, 2], [0, 1, 2]]], [[0, 1, 2]])
        for time, distance in ((-1, 4.5), (0, 4.5), (1.5, 3), (9, 2.5)):
            self.assertAlmostEqual(kds.shape_distance(sheet, kds.sphere(0.5), (0.2, 0.2, 5), time=time).distance, distance)


if __name__ == "__main__":
    unittest.main()
