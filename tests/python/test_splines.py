"""Worlds of degree 3 to 5: curves from arrays, against NumPy, which shares no code with the library."""

import pickle
import unittest

import kds
import numpy as np

# Times of contacts here are simple roots, of order 1 s with slopes of order 1, which both sides find to some roundings.
TIME_ERROR = 1e-9


def first_root(coefficients, end):
    """The first root in (0, end) of a polynomial, lowest coefficient first, at which it becomes negative."""
    roots = np.polynomial.polynomial.polyroots(coefficients)
    slope = np.polynomial.polynomial.polyder(coefficients)
    real = sorted(root.real for root in roots if abs(root.imag) < 1e-7 and 0 < root.real < end)
    return next((root for root in real if np.polynomial.polynomial.polyval(root, slope) < 0), None)


def gap(a, b, sum_of_radii):
    """|b - a|^2 - sum_of_radii^2 as a polynomial of the time, of paths (k, 3)."""
    total = np.zeros(2 * len(a) - 1)
    for axis in range(3):
        total += np.polynomial.polynomial.polymul(b[:, axis] - a[:, axis], b[:, axis] - a[:, axis])
    total[0] -= sum_of_radii**2
    return total


class Splines(unittest.TestCase):
    def test_contacts_of_random_curves(self):
        found = 0
        for degree in (3, 4, 5):
            for seed in range(4):
                with self.subTest(degree=degree, seed=seed):
                    random = np.random.default_rng(10 * degree + seed)
                    n, end, sum_of_radii = 40, 2.0, 1.0
                    paths = random.normal(0, 1, (n, degree + 1, 3))
                    paths[:, 0] *= 3
                    world = kds.World(degree)
                    world.add_bodies(None, paths[:, 0], paths[:, 1], 2 * paths[:, 2], higher=paths[:, 3:], radii=sum_of_radii / 2)
                    events = world.advance_to(end)
                    firsts = {}
                    for event in events[events.kind == kds.EventKind.CONTACT]:
                        firsts.setdefault((int(event.a), int(event.b)), event.time)
                    for a in range(n):
                        for b in range(a + 1, n):
                            distance = gap(paths[a], paths[b], sum_of_radii)
                            if distance[0] <= 0:
                                continue  # they overlap at the beginning
                            time = first_root(distance, end)
                            if time is None:
                                self.assertNotIn((a, b), firsts)
                            else:
                                self.assertAlmostEqual(firsts[a, b], time, delta=TIME_ERROR)
                                found += 1
                    world.audit()
        self.assertGreater(found, 100)

    def test_one_by_one_and_bulk_are_the_same_and_can_be_saved(self):
        random = np.random.default_rng(5)
        n, k = 40, 3
        starts = np.cumsum(random.uniform(0.2, 0.6, (n, k)), axis=1)
        first, later = random.normal(0, 1, (n, 4, 3)), random.normal(0, 1, (n, k, 4, 3))
        first[:, 0] *= 3
        later[:, :, 0] *= 3
        script = kds.Motion(starts, later[:, :, 0], later[:, :, 1], 2 * later[:, :, 2], higher=later[:, :, 3:])
        bulk, single, updated = kds.World(3), kds.World(3), kds.World(3)
        bulk.add_bodies(None, first[:, 0], first[:, 1], 2 * first[:, 2], higher=first[:, 3:], radii=0.8, then=script)
        for i in range(n):
            pieces = kds.Motion(starts[i], later[i, :, 0], later[i, :, 1], 2 * later[i, :, 2], higher=later[i, :, 3:])
            single.add_body(kds.sphere(0.8), first[i, 0], first[i, 1], 2 * first[i, 2], higher=first[i, 3:], then=pieces)
        ids = updated.add_bodies(None, np.full((n, 3), 50.0) + 2 * np.arange(n)[:, None], radii=0.8)
        updated.update_motions(ids, positions=first[:, 0], velocities=first[:, 1], accelerations=2 * first[:, 2],
                               higher=first[:, 3:], then=script)  # fmt: skip
        half = bulk.advance_to(0.7), single.advance_to(0.7)
        saved = bulk.save()
        copies = [pickle.loads(pickle.dumps(bulk)) for _ in range(2)]
        rest = [world.advance_to(2.5) for world in (bulk, single, *copies)]
        self.assertEqual(half[0].tobytes(), half[1].tobytes())
        for other in rest[1:]:
            self.assertEqual(rest[0].tobytes(), other.tobytes())
        self.assertGreater(len(half[0]) + len(rest[0]), 50)
        # Bodies that jump to where others are overlap them there.
        again = updated.advance_to(2.5)
        whole = np.concatenate([half[0], rest[0]])
        meets = again[(again.kind == kds.EventKind.CONTACT) & (again.time > 0)]
        self.assertEqual(meets.time.tolist(), whole["time"][whole["kind"] == kds.EventKind.CONTACT].tolist())
        bulk.load(saved)
        self.assertEqual(bulk.advance_to(2.5).tobytes(), rest[0].tobytes())

    def test_a_stream_of_cubics_is_the_whole_script(self):
        random = np.random.default_rng(8)
        times = np.cumsum(random.uniform(0.5, 1, 12))
        way = kds.Motion.through(times, random.normal(0, 3, (12, 3)), random.normal(0, 2, (12, 3)))
        obstacles = random.uniform(-5, 5, (100, 3))

        def world():
            made = kds.World(3, report_pieces=True)
            made.add_bodies(None, obstacles, radii=0.5)
            return made

        whole, streamed = world(), world()
        whole.add_body(kds.sphere(0.3), way)

        def piece(i):
            return kds.Motion(times[i], way.position[i], way.velocity[i], way.acceleration[i], higher=way.higher[i])

        body = streamed.add_body(kds.sphere(0.3), piece(0))
        log = b""
        for i in range(1, 12):
            streamed.append_motion(body, piece(i))
            log += streamed.advance_to(times[i - 1] + 0.25).tobytes()
        log += streamed.advance_to(times[-1] + 3).tobytes()
        events = whole.advance_to(times[-1] + 3)
        self.assertGreater((events.kind == kds.EventKind.CONTACT).sum(), 5)
        self.assertEqual(log, events.tobytes())

    def test_way_points_are_reached(self):
        random = np.random.default_rng(3)
        times = np.cumsum(random.uniform(0.1, 2, 20))
        x, v, a = random.normal(0, 5, (3, 20, 3))
        for accelerations, bound in ((None, 2.0**-48), (a, 2.0**-45)):
            way = kds.Motion.through(times, x, v, accelerations)
            for i in range(19):
                duration = times[i + 1] - times[i]
                c = [way.position[i], way.velocity[i], way.acceleration[i] / 2, *way.higher[i]]
                terms = np.array([c[k] * duration**k for k in range(len(c))])
                size = np.abs(x[i]) + np.abs(x[i + 1]) + duration * (np.abs(v[i]) + np.abs(v[i + 1]))
                if accelerations is not None:
                    size += duration**2 * (np.abs(a[i]) + np.abs(a[i + 1]))
                self.assertTrue((np.abs(terms.sum(0) - x[i + 1]) < bound * size).all())
                rate = sum(k * c[k] * duration ** (k - 1) for k in range(1, len(c)))
                self.assertTrue((np.abs(rate - v[i + 1]) * duration < 6 * bound * size).all())
                if accelerations is not None:
                    bend = sum(k * (k - 1) * c[k] * duration ** (k - 2) for k in range(2, len(c)))
                    self.assertTrue((np.abs(bend - a[i + 1]) * duration**2 < 21 * bound * size).all())
            self.assertFalse(np.any(way.higher[-1]))

    def test_what_is_left_out_stays_and_what_is_asked_is_of_now(self):
        world = kds.World(4)
        body = world.add_body(kds.sphere(1), (1, 0, 0), higher=[[0, 1, 0], [0, 0, 2]])
        world.advance_to(1)
        np.testing.assert_array_equal(world.position(body), [1, 1, 2])
        np.testing.assert_array_equal(world.velocity(body), [0, 3, 8])
        np.testing.assert_array_equal(world.accelerations()[0], [0, 6, 24])
        np.testing.assert_array_equal(world.higher()[0], [[0, 1, 8], [0, 0, 2], [0, 0, 0]])
        world.update_motion(body, velocity=(0, 0, 0))
        np.testing.assert_array_equal(world.higher()[0], [[0, 1, 8], [0, 0, 2], [0, 0, 0]])
        world.update_motion(body, higher=())
        self.assertFalse(world.higher().any())
        world.update_motions([body], higher=[[1, 0, 0]])
        np.testing.assert_array_equal(world.higher()[0, 0], [1, 0, 0])
        hit = world.next_contact(kds.sphere(1), (1, 1, 62), higher=[[0, 0, 0], [0, 0, 0]], until=9)
        self.assertIsNone(hit)
        other = kds.World(3)
        wall = other.add_body(kds.box((1, 1, 1)), (0, 0, 0))
        hit = other.next_contact(kds.sphere(1), (0, 0, 10), higher=[[0, 0, -1]], until=9)
        self.assertEqual((hit.a, hit.time), (wall, 2))

    def test_misuse(self):
        plane, cubic = kds.World(2), kds.World(3)
        body = cubic.add_body(kds.sphere(1), (0, 0, 0))
        none = np.zeros((2, 3))
        for pattern, call in (
            (r"motion\.higher\[0\]: must be 0 in a world of degree 2", lambda: plane.add_body(kds.sphere(1), (0, 0, 0), higher=[[1, 0, 0]])),
            (r"bodies\[1\]: motion\.higher\[1\]: must be 0 in a world of degree 3",
             lambda: cubic.add_bodies(kds.sphere(1), none, higher=[[[0, 0, 0]] * 2, [[1, 0, 0], [0, 0, 1]]])),
            (r"higher: must have the shape \(k, 3\), k from 1 to 3, and has \(3,\)", lambda: cubic.update_motion(body, higher=(1, 2, 3))),
            (r"higher: must have the shape \(2, k, 3\)", lambda: cubic.add_bodies(kds.sphere(1), none, higher=np.zeros((3, 1, 3)))),
            (r"higher: must have the shape .* and has \(4, 3\)", lambda: cubic.add_body(kds.sphere(1), (0, 0, 0), higher=np.zeros((4, 3)))),
            (r"motion of body 0: must be finite", lambda: cubic.update_motion(body, higher=[[np.nan, 0, 0]])),
            (r"then\[0\]: must be finite", lambda: cubic.update_motion(body, then=kds.Motion(1, (0, 0, np.inf)))),
            (r"times: must be at least two, finite, and ascend", lambda: kds.Motion.through([0, 0], none, none)),
            (r"velocities: must have the shape \(2, 3\)", lambda: kds.Motion.through([0, 1], none, none[:1])),
            (r"then\[1, 0\]\.start: must be later than 0.0, and is -1.0",
             lambda: cubic.add_bodies(kds.sphere(1), none + 9, then=kds.Motion([[1], [-1]], (0, 0, 0)))),
            (r"then\.start: must have the shape \(2, n\)",
             lambda: cubic.add_bodies(kds.sphere(1), none + 9, then=kds.Motion([[1]] * 3, (0, 0, 0)))),
            (r"velocity: must be left out where position is a kds.Motion: that has all pieces", lambda: cubic.add_body(kds.sphere(1), kds.Motion(0, (0, 0, 0)), (1, 0, 0))),
            (r"then: must be left out", lambda: cubic.add_body(kds.sphere(1), kds.Motion(0, (0, 0, 0)), then=[kds.Motion(1, (0, 0, 0))])),
            (r"position: has no pieces", lambda: cubic.add_body(kds.sphere(1), kds.Motion([], (0, 0, 0)))),
        ):  # fmt: skip
            with self.subTest(pattern=pattern):
                with self.assertRaisesRegex(ValueError, pattern):
                    call()
        self.assertEqual((len(plane), len(cubic)), (0, 1))


if __name__ == "__main__":
    unittest.main()
