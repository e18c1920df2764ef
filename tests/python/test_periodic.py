"""Worlds in a periodic box, and worlds that are run in domains."""

import pickle
import unittest

import kds
import numpy as np


def gas(seed, n=60, side=6.0, **options):
    random = np.random.default_rng(seed)
    world = kds.PeriodicWorld((0, 0, 0), (side,) * 3, **options)
    places = np.stack(np.meshgrid(*[np.arange(0.5, side)] * 3), -1).reshape(-1, 3)[:n] * 1.0
    world.add_bodies(None, places, random.normal(0, 2, (n, 3)), radii=random.uniform(0.2, 0.4, n),
                     masses=random.uniform(0.5, 2, n), user_data=np.arange(n) + 100)  # fmt: skip
    return world


class Periodic(unittest.TestCase):
    def test_two_balls_meet_across_the_end(self):
        world = kds.PeriodicWorld((0, 0, 0), (8, 8, 8))
        a = world.add_body(kds.sphere(0.5), (1, 4, 4), (-1, 0, 0), user_data=7)
        b = world.add_body(kds.sphere(0.5), (7, 4, 4), (1, 0, 0), user_data=9)
        (event,) = world.advance_to(0.5)
        self.assertEqual((event.time, event.kind, event.a, event.b), (0.5, kds.EventKind.CONTACT, a, b))
        self.assertEqual((event.offset.tolist(), event.impulse), ([-1, 0, 0], 2.0))
        self.assertEqual((event.user_data_a, event.user_data_b), (7, 9))
        np.testing.assert_array_equal(event.normal, (-1, 0, 0))
        np.testing.assert_array_equal(world.velocities(), [[1, 0, 0], [-1, 0, 0]])

    def test_momentum_energy_and_unwrapped_paths(self):
        for seed, degree in ((1, 1), (2, 2)):
            with self.subTest(seed=seed):
                world = gas(seed, degree=degree)
                masses = np.random.default_rng(seed)  # the numbers that gas() drew
                masses.normal(0, 2, (60, 3)), masses.uniform(0.2, 0.4, 60)
                m = masses.uniform(0.5, 2, 60)[:, None]
                before = (m * world.velocities()).sum(0), (m * world.velocities() ** 2).sum()
                last, travelled = world.unwrapped_positions(), np.zeros((60, 3))
                wraps = 0
                for t in np.arange(0.01, 3, 0.01):
                    events = world.advance_to(t)
                    wraps += (events.kind == kds.EventKind.WRAP).sum()
                    here = world.unwrapped_positions()
                    self.assertLess(np.abs(here - last).max(), 0.2)  # no jump of a period
                    last = here
                    x = world.positions()
                    self.assertTrue(((x > -0.2) & (x < 6.2)).all())
                np.testing.assert_allclose((m * world.velocities()).sum(0), before[0], atol=1e-11)
                np.testing.assert_allclose((m * world.velocities() ** 2).sum(), before[1], rtol=1e-12)
                self.assertGreater(wraps, 50)
                self.assertEqual(world.counters["wraps"], wraps)
                self.assertGreater(np.abs(world.crossings()).max(), 0)
                world.audit()

    def test_broad_phases_steps_and_snapshots_make_no_difference(self):
        for options in ({}, {"shear_rate": 1.5}, {"boundaries": ("periodic", "periodic", "walls"), "wall_temperatures": [0, 0, 0, 0, 2, 1]}):
            with self.subTest(options=options):
                whole = gas(3, **options)
                events = whole.advance_to(3)
                self.assertGreater((events.kind == kds.EventKind.CONTACT).sum(), 100)
                other = gas(3, broad_phase="kinetic-sap", **options)
                self.assertEqual(other.advance_to(3).tobytes(), events.tobytes())
                stepped = gas(3, **options)
                while stepped.step(1.5):
                    pass
                first = stepped.take_events()
                later = pickle.loads(pickle.dumps(stepped))
                self.assertEqual(first.tobytes() + later.advance_to(3).tobytes(), events.tobytes())
                saved = stepped.save()
                stepped.advance_to(3)
                stepped.load(saved)
                self.assertEqual(first.tobytes() + stepped.advance_to(3).tobytes(), events.tobytes())

    def test_functions_change_bodies(self):
        world = gas(4)
        removed = []

        def absorb(event):
            removed.append(int(event.b))
            world.remove_body(int(event.b))
            world.update_motion(int(event.a), velocity=(0, 0, 1))

        world.on(kds.EventKind.CONTACT, absorb)
        world.advance_to(2)
        self.assertGreater(len(removed), 10)
        self.assertEqual(len(world), 60 - len(removed))
        self.assertEqual(set(world.bodies.tolist()), set(range(60)) - set(removed))
        world.audit()

    def test_misuse(self):
        world = kds.PeriodicWorld((0, 0, 0), (8, 8, 8))
        ids = world.add_bodies(kds.sphere(1), [[1, 1, 1], [4, 4, 4]])
        ball = kds.sphere(1)
        for pattern, call in (
            ("degree: must be 1 .* in a periodic world, not 3", lambda: kds.PeriodicWorld((0, 0, 0), (1, 1, 1), 3)),
            ("boundaries: must be 'periodic', 'walls' or 'open', not 'none'", lambda: kds.PeriodicWorld((0, 0, 0), (1, 1, 1), boundaries="none")),
            ("x of min must be below", lambda: kds.PeriodicWorld((0, 0, 0), (0, 1, 1))),
            ("shear_rate: needs periodic x and y", lambda: kds.PeriodicWorld((0, 0, 0), (1, 1, 1), boundaries="open", shear_rate=1)),
            ("radius.*half the period", lambda: world.add_body(kds.sphere(4), (0, 0, 0))),
            ("sensor", lambda: world.add_body(ball, (0, 0, 0), sensor=True)),
            ("one piece|pieces", lambda: world.add_body(ball, (0, 0, 0), then=kds.Motion(1, (0, 0, 0)))),
            ("then: in a periodic world a motion has one piece", lambda: world.update_motion(ids[0], then=kds.Motion(1, (0, 0, 0)))),
            ("acceleration: must be 0 in a world of degree 1", lambda: world.update_motion(ids[0], acceleration=(0, 0, 1))),
            (r"motion of body 1: more than 2\^31 periods away", lambda: world.update_motions(ids, positions=[[0, 0, 0], [0, 1e12, 0]])),
            ("motion of body 1: must be finite", lambda: world.update_motions(ids, velocities=[[9, 0, 0], [np.nan, 0, 0]])),
            ("restitution of body 1", lambda: world.set_restitution(ids, [0.5, 2])),
            ("limit: must be finite", lambda: world.step(np.inf)),
            ("no body 99", lambda: world.crossings([99])),
            ("orientation: bodies keep theirs", lambda: world.update_motion(ids[0], orientation=(1, 0, 0, 0))),
        ):  # fmt: skip
            with self.subTest(pattern=pattern):
                with self.assertRaisesRegex(ValueError, pattern):
                    call()
        self.assertEqual(len(world), 2)
        self.assertFalse(world.velocities().any())


class Domains(unittest.TestCase):
    def world(self, seed, **options):
        random = np.random.default_rng(seed)
        n = 2000
        world = kds.World(response="elastic", walls=((0, 0, 0), (40, 40, 40)), **options)
        places = np.stack(np.meshgrid(*[np.arange(1.5, 39, 2.8)] * 3), -1).reshape(-1, 3)[:n]
        world.add_bodies(None, places, random.normal(0, 3, (n, 3)), radii=random.uniform(0.3, 1, n))
        return world

    def test_events_are_those_of_one_world(self):
        for seed, degree, turning in ((1, 1, False), (2, 2, False), (3, 3, False), (5, 5, False), (6, 1, True)):
            with self.subTest(seed=seed):
                options = dict(degree=degree, turning=turning)
                one, many = self.world(seed, **options), self.world(seed, **options, domains=4, threads=2)
                logs = []
                for world in (one, many):
                    log = world.advance_to(0.5).tobytes()
                    world.update_motions([7, 11], velocities=[[5, 0, 0], [0, 5, 0]])
                    world.remove_body(3)
                    log += world.advance_to(1).tobytes()
                    self.assertEqual(world.now, 1)
                    logs.append(log)
                self.assertGreater(len(logs[0]), 120 * 1000)
                self.assertEqual(logs[0], logs[1])
                self.assertEqual(one.positions().tobytes(), many.positions().tobytes())
                copies = [pickle.loads(pickle.dumps(many))]
                other = self.world(seed, **options)
                other.load(many.save())
                copies.append(other)
                expected = one.advance_to(1.3).tobytes()
                for world in (many, *copies):
                    self.assertEqual(world.advance_to(1.3).tobytes(), expected)
                many.audit()

    def test_what_it_cannot_do_is_refused(self):
        world = self.world(1, domains=2)
        with self.assertRaisesRegex(ValueError, "on: a world in domains calls no functions"):
            world.on(kds.EventKind.CONTACT, print)
        with self.assertRaisesRegex(RuntimeError, "step: a world in domains goes by advance_to"):
            world.step(1)
        self.assertIn("in domains", repr(world))


if __name__ == "__main__":
    unittest.main()
