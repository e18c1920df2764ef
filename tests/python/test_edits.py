"""What is changed while a world runs: scripts, masses, restitutions, filters, user data; and timers."""

import pickle
import unittest

import kds
import numpy as np


def kinds(events):
    return [kds.EventKind(kind).name for kind in events.kind]


def two_balls(**options):
    """They meet at 2 s, in the origin."""
    world = kds.World(**options)
    a, b = world.add_bodies(kds.sphere(1), [[-3, 0, 0], [3, 0, 0]], [[1, 0, 0], [-1, 0, 0]], user_data=[2**64 - 1, 7])
    return world, int(a), int(b)


def zigzag(pieces, seed):
    """Starts, places and velocities of a way without jumps, up to roundings."""
    random = np.random.default_rng(seed)
    starts = np.concatenate([[0], np.cumsum(random.uniform(0.3, 1, pieces - 1))])
    velocities = random.normal(0, 2, (pieces, 3))
    ways = np.diff(starts)[:, None] * velocities[:-1]
    return starts, np.concatenate([np.zeros((1, 3)), np.cumsum(ways, axis=0)]), velocities


class Attached(unittest.TestCase):
    def test_an_alarm_moves_with_its_body_and_goes_with_it(self):
        world = kds.World(response="elastic")
        a, b = world.add_bodies(kds.sphere(1), [[0, 0, 0], [10, 0, 0]], [[1, 0, 0], [0, 0, 0]])
        alarm = world.attach_sensor(a, kds.sphere(2), user_data=5)
        events = world.advance_to(7.5)
        self.assertEqual(kinds(events), ["CONTACT"])
        self.assertEqual((events[0].time, events[0].a, events[0].b), (7, b, alarm))
        self.assertEqual((events[0].user_data_a, events[0].user_data_b), (0, 5))
        world.update_motions([a], positions=[[0, 0, 0]], velocities=[[0, 1, 0]])
        self.assertTrue(np.array_equal(world.position(alarm), [0, 0, 0]))
        with self.assertRaisesRegex(ValueError, "is attached to body 0"):
            world.update_motions([alarm], positions=[[0, 0, 0]])
        with self.assertRaisesRegex(ValueError, "attached to another itself"):
            world.attach_sensor(alarm, kds.sphere(1))
        world.remove_body(a)
        self.assertNotIn(alarm, world)

    def test_groups_and_pairs_that_are_ignored(self):
        for group in (0, 3):
            with self.subTest(group=group):
                world = kds.World()
                a, b = world.add_bodies(kds.sphere(1), [[-3, 0, 0], [3, 0, 0]], [[1, 0, 0], [-1, 0, 0]], groups=group)
                self.assertEqual(world.group(a), group)
                world.ignore_pair(a, b, group == 0)
                self.assertEqual(world.ignores_pair(b, a), group == 0)
                self.assertEqual(len(world.advance_to(2.5)), 0)
                world.ignore_pair(a, b, False)
                world.set_filter(a, group=0)
                self.assertEqual(kinds(world.advance_to(2.75)), ["OVERLAP"])
        with self.assertRaisesRegex(ValueError, "and itself are no pair"):
            world.ignore_pair(a, a)


class Scripts(unittest.TestCase):
    def world_of(self, seed):
        world = kds.World(report_pieces=True)
        world.add_bodies(None, np.random.default_rng(seed).uniform(-5, 5, (200, 3)), radii=0.3)
        return world

    def test_a_stream_gives_the_events_of_the_whole_script(self):
        for seed in range(3):
            with self.subTest(seed=seed):
                starts, places, velocities = zigzag(12, seed)
                motions = [kds.Motion(*piece) for piece in zip(starts, places, velocities)]
                arrays = kds.Motion(starts[1:], places[1:], velocities[1:])
                runs = []
                for then in (motions[1:], arrays):
                    world = self.world_of(seed)
                    world.add_body(kds.sphere(0.5), places[0], velocities[0], then=then, user_data=5)
                    runs.append(world.advance_to(12).tobytes())
                world = self.world_of(seed)
                body = world.add_body(kds.sphere(0.5), places[0], velocities[0], then=motions[1:2], user_data=5)
                to_come = motions[2:]

                def go_on(event):
                    self.assertEqual((event.a, event.b, event.user_data_a), (body, body, 5))
                    if to_come:
                        world.append_motion(int(event.a), to_come.pop(0))

                world.on(kds.EventKind.PIECE, go_on)
                events = world.advance_to(12)
                runs.append(events.tobytes())
                world = self.world_of(seed)
                body = world.add_body(kds.sphere(0.5), places[0], velocities[0], user_data=5)
                world.append_motion(body, arrays)
                runs.append(world.advance_to(12).tobytes())
                self.assertEqual(runs.count(runs[0]), 4)
                self.assertEqual(events.time[events.kind == kds.EventKind.PIECE].tolist(), starts[1:].tolist())
                self.assertGreater((events.kind == kds.EventKind.CONTACT).sum(), 5)

    def test_a_new_script_replaces_what_was_to_come(self):
        world = kds.World(degree=2)
        body = world.add_body(kds.sphere(1), (0, 0, 0), (1, 0, 0), then=[kds.Motion(5, (0, 9, 0))])
        world.advance_to(2)
        world.update_motion(body, velocity=(0, 1, 0), then=[kds.Motion(3, (2, 1, 0), acceleration=(0, 0, 2))])
        world.advance_to(2.5)
        np.testing.assert_array_equal(world.position(body), [2, 0.5, 0])
        world.advance_to(6)
        np.testing.assert_array_equal(world.position(body), [2, 1, 9])
        self.assertEqual(len(world.take_events()), 0)  # pieces are not reported here

    def test_pieces_that_turn(self):
        world = kds.World(turning=True)
        half = np.sqrt(0.5)
        body = world.add_body(kds.box((1, 2, 3)), (0, 0, 0), fixed=True)
        world.append_motion(body, kds.Motion([1, 2], (0, 0, 0), angular_velocity=[[1, 0, 0], [0, 0, 0]],
                                             orientation=[[1, 0, 0, 0], [half, half, 0, 0]]))  # fmt: skip
        world.advance_to(1.5)
        np.testing.assert_array_equal(world.angular_velocities(), [[1, 0, 0]])
        world.advance_to(3)
        np.testing.assert_array_equal(world.orientations(), [[half, half, 0, 0]])

    def test_scripts_that_make_no_sense_change_nothing(self):
        world = kds.World()
        body = world.add_body(kds.sphere(1), (0, 0, 0), (1, 0, 0))
        world.advance_to(1)
        before = world.save()
        m, zero = kds.Motion, (0, 0, 0)
        for pattern, call in (
            (r"then: must be a kds.Motion or a sequence of them, and is 3", lambda: world.update_motion(body, then=3)),
            (r"then\[1\]: must be a kds.Motion", lambda: world.update_motion(body, then=[m(2, zero), 3])),
            (r"then\[0\].start: must be later than 1.0, and is 1.0", lambda: world.update_motion(body, then=[m(1, zero)])),
            (r"then\[1\].start: must be later than 3.0", lambda: world.update_motion(body, then=m([3, 2], zero))),
            (r"then\[0\].start: must be later than 1.0, and is nan", lambda: world.update_motion(body, then=m(np.nan, zero))),
            (r"then\[0\].start: must be a number", lambda: world.update_motion(body, then=m("x", zero))),
            (r"then\[1\]: must be finite", lambda: world.update_motion(body, then=[m(2, zero), m(3, zero, (0, np.inf, 0))])),
            (r"then.position: must have the shape \(2, 3\), and has \(3, 3\)",
             lambda: world.update_motion(body, then=m([3, 4], np.zeros((3, 3))))),
            (r"then\[0\].acceleration: must be 0 in a world of degree 1",
             lambda: world.update_motion(body, then=m(2, zero, zero, (1, 0, 0)))),
            (r"motion\[1\].start: must be later than 3.0", lambda: world.append_motion(body, m([3, 3], zero))),
            (r"motion\[0\].start: must be later than 1.0", lambda: world.append_motion(body, m(1, zero))),
            (r"motion\[0\].velocity: must have the shape \(3,\)", lambda: world.append_motion(body, m(2, zero, (1, 2)))),
            (r"77", lambda: world.append_motion(77, m(2, zero))),
        ):  # fmt: skip
            with self.subTest(pattern):
                with self.assertRaisesRegex(ValueError, pattern):
                    call()
                self.assertEqual(world.save(), before)
        world.append_motion(body, [])
        self.assertEqual(world.save(), before)
        world.append_motion(body, m(3, zero))
        with self.assertRaisesRegex(ValueError, r"motion\[0\].start.*the last piece, 3"):
            world.append_motion(body, m(2, zero))


class Timers(unittest.TestCase):
    def test_they_ring_in_order_and_after_a_snapshot_too(self):
        world, *_ = two_balls(response="elastic")
        self.assertEqual([world.set_timer(t) for t in (2, 1, 2, 1.5)], [0, 1, 2, 3])
        self.assertTrue(world.cancel_timer(3))
        self.assertFalse(world.cancel_timer(3))
        self.assertFalse(world.cancel_timer(99))
        world.advance_to(0.5)
        self.assertEqual(world.next_time, 1)
        for each in (pickle.loads(pickle.dumps(world)), world):
            rung = []

            def ring(event, each=each, rung=rung):
                rung.append((event.time, int(event.a), int(event.b)))
                if len(rung) == 1:
                    self.assertEqual(each.set_timer(1), 4)

            each.on(kds.EventKind.TIMER, ring)
            events = each.advance_to(3)
            self.assertEqual(rung, [(1, 1, 1), (1, 4, 4), (2, 0, 0), (2, 2, 2)])
            self.assertEqual(kinds(events), ["TIMER"] * 4 + ["CONTACT"])
        for t, pattern in ((1, "not a finite time"), (np.inf, "not a finite time"), ("x", "^t: must be a number")):
            with self.assertRaisesRegex(ValueError, pattern):
                world.set_timer(t)
        with self.assertRaisesRegex(ValueError, "timer: must be a whole number"):
            world.cancel_timer(-1)


class Properties(unittest.TestCase):
    def test_masses_and_restitutions_count_from_the_next_contact_on(self):
        world, a, b = two_balls(response="elastic")
        world.advance_to(1)
        world.set_mass(a, 3)
        self.assertEqual((world.mass(a), world.mass(b)), (3, 1))
        world.advance_to(2.5)
        np.testing.assert_allclose(world.velocities()[:, 0], [0, 2], atol=1e-15)  # roundings of numbers near 1
        world.update_motion(b, position=(10, 0, 0), velocity=(-1, 0, 0))
        world.set_restitution([a, b], [0.5, 0.75])
        self.assertEqual((world.restitution(a), world.restitution(b)), (0.5, 0.75))
        world.advance_to(20)
        self.assertAlmostEqual(world.velocity(b)[0] - world.velocity(a)[0], 0.5, places=14)

    def test_all_change_or_none(self):
        world = kds.World()
        ids = world.add_bodies(kds.sphere(1), np.arange(9).reshape(3, 3) * 5, fixed=[False, False, True])
        before = world.save()
        for pattern, call in (
            (r"mass of body 1: ", lambda: world.set_mass(ids[:2], [2, -1])),
            (r"body 2 is fixed", lambda: world.set_mass(ids, 2)),
            (r"mass: must have the shape \(3,\), and has \(2,\)", lambda: world.set_mass(ids, [1, 2])),
            (r"mass: must be real numbers", lambda: world.set_mass(0, "heavy")),
            (r"restitution of body 1: must be in \[0, 1\]", lambda: world.set_restitution(ids, [0, 1.5, 0])),
            (r"restitution of body 0: must be in", lambda: world.set_restitution(0, np.nan)),
            (r"no body 9", lambda: world.set_restitution([0, 9], 0.5)),
            (r"no body 9", lambda: world.set_mass([0, 9], 2)),
            (r"no body 9", lambda: world.set_filter([0, 9], 2)),
            (r"no body 9", lambda: world.set_user_data([0, 9], 2)),
            (r"category: must be whole numbers of shape \(1,\)", lambda: world.set_filter(0, 1.5)),
            (r"collides_with: must be numbers of 32 bits", lambda: world.set_filter(0, 1, 2**32)),
            (r"user_data: must be numbers of 64 bits", lambda: world.set_user_data(0, -1)),
            (r"user_data: must be whole numbers", lambda: world.set_user_data(0, 2**64)),
            (r"bodies: must be the id of a body", lambda: world.set_mass("a", 2)),
            (r"bodies: must be ids", lambda: world.set_mass([[0]], 2)),
        ):
            with self.subTest(pattern):
                with self.assertRaisesRegex(ValueError, pattern):
                    call()
                self.assertEqual(world.save(), before)

    def test_events_carry_user_data(self):
        world, a, b = two_balls(walls=((-10,) * 3, (10,) * 3))
        self.assertEqual((world.user_data(a), world.user_data(b)), (2**64 - 1, 7))
        hit = world.next_contact_of(a, until=9)
        self.assertEqual((hit.a, hit.user_data_a), (b, 7))
        hit = world.next_contact_between(a, b, until=9)
        self.assertEqual((hit.user_data_a, hit.user_data_b), (2**64 - 1, 7))
        self.assertEqual(world.cast((-9, 0, 0), (9, 0, 0)).user_data_a, 2**64 - 1)
        (met,) = world.advance_to(2.5)
        world.remove_body(a)
        world.set_user_data(b, 8)
        left, wall = world.advance_to(15)
        self.assertEqual((met.user_data_a, met.user_data_b), (2**64 - 1, 7))
        self.assertEqual((left.user_data_a, left.user_data_b), (2**64 - 1, 8))
        self.assertEqual((wall.kind, wall.a, wall.user_data_a, wall.user_data_b), (kds.EventKind.WALL, b, 8, 0))

    def test_many_at_once(self):
        world = kds.World()
        ids = world.add_bodies(kds.sphere(0.1), np.random.default_rng(0).uniform(-100, 100, (1000, 3)), user_data=3)
        world.set_mass(ids, np.arange(1, 1001))
        world.set_restitution(ids, 0.25)
        world.set_filter(ids[500:], 2, 0)
        world.set_user_data(ids, ids + np.uint64(1))
        for i in (0, 499, 500, 999):
            self.assertEqual((world.mass(i), world.restitution(i), world.user_data(i)), (i + 1, 0.25, i + 1))
            masks = (1, 0xFFFFFFFF) if i < 500 else (2, 0)
            self.assertEqual((world.category(i), world.collides_with(i)), masks)


class Filters(unittest.TestCase):
    def test_they_begin_and_end_contacts(self):
        world, a, b = two_balls()
        self.assertEqual(kinds(world.advance_to(2.5)), ["CONTACT"])
        self.assertEqual(world.partners(a).tolist(), [b])
        world.set_filter(a, collides_with=2)
        self.assertEqual((world.category(a), world.collides_with(a)), (1, 2))
        self.assertEqual(kinds(world.advance_to(2.75)), ["SEPARATION"])
        self.assertEqual(world.partners(a).tolist(), [])
        world.set_filter(b, 2)
        events = world.advance_to(10)
        self.assertEqual(kinds(events), ["OVERLAP", "SEPARATION"])
        self.assertEqual(events.time.tolist(), [2.75, 4])

    def test_what_rests_wakes(self):
        world = kds.World(degree=2, response="elastic")
        floor = world.add_body(kds.box((5, 5, 1)), (0, 0, -1), fixed=True, category=2)
        ball = world.add_body(kds.sphere(0.5), (0, 0, 0.75), acceleration=(0, 0, -5), restitution=0.25)
        world.advance_to(5)
        self.assertEqual(world.partners(ball).tolist(), [floor])
        world.set_timer(6)
        world.on(kds.EventKind.TIMER, lambda event: world.set_filter(ball, 1, ~np.uint32(2)))
        events = world.advance_to(7)
        self.assertEqual([(e.time, e.kind) for e in events], [(6, kds.EventKind.TIMER), (6, kds.EventKind.WAKE)])
        self.assertEqual(world.partners(floor).tolist(), [])
        self.assertAlmostEqual(world.position(ball)[2], 0.5 - 2.5, places=12)
        with self.assertRaisesRegex(ValueError, "no body 9"):
            world.partners(9)


if __name__ == "__main__":
    unittest.main()
