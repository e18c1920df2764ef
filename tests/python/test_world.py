"""Bodies in bulk and one by one, motions, callbacks, snapshots, threads."""

import copy
import gc
import pickle
import threading
import time
import unittest
import weakref

import kds
import numpy as np


def gas(n, seed, **options):
    """Balls between walls, and what they were made of."""
    random = np.random.default_rng(seed)
    side = 4 * int(np.ceil(n ** (1 / 3)))
    places = np.stack(np.meshgrid(*[np.arange(2.0, side, 4)] * 3), -1).reshape(-1, 3)[:n]
    data = dict(
        positions=places + random.uniform(-0.9, 0.9, (n, 3)),
        velocities=random.normal(0, 3, (n, 3)),
        radii=random.uniform(0.3, 1, n),
        masses=random.uniform(0.5, 2, n),
        restitutions=random.uniform(0.5, 1, n),
    )
    world = kds.World(walls=((0, 0, 0), (side,) * 3), **{"response": "elastic", **options})
    return world, data


class Bulk(unittest.TestCase):
    def test_bulk_equals_one_by_one(self):
        for seed in range(3):
            with self.subTest(seed=seed):
                together, data = gas(200, seed, degree=2)
                together.add_bodies(None, accelerations=(0, 0, -1), collide_with=3, categories=2, **data)
                single, _ = gas(200, seed, degree=2)
                for i in range(200):
                    single.add_body(
                        kds.sphere(data["radii"][i]),
                        data["positions"][i],
                        data["velocities"][i],
                        (0, 0, -1),
                        mass=data["masses"][i],
                        restitution=data["restitutions"][i],
                        category=2,
                        collides_with=3,
                    )
                first, second = together.advance_to(2), single.advance_to(2)
                self.assertGreater(len(first), 100)
                self.assertEqual(first.tobytes(), second.tobytes())
                self.assertEqual(together.save(), single.save())

    def test_one_shape_for_all_and_several(self):
        places = np.array([[0, 0, 0], [5, 0, 0], [10, 0, 0]])
        world = kds.World()
        world.add_bodies(kds.box((1, 1, 1)), places)
        world.add_bodies([kds.sphere(1), kds.capsule(1, 1), kds.hull(np.vstack([np.zeros(3), np.eye(3)]))], places + 20)
        self.assertEqual([world.shape(i).kind for i in range(6)], ["box"] * 3 + ["sphere", "capsule", "hull"])
        np.testing.assert_array_equal(world.positions(), np.vstack([places, places + 20]))

    def test_a_box_meets_a_floor(self):
        world = kds.World()
        world.add_body(kds.half_space((0, 0, 1), -1), (0, 0, 0), fixed=True)
        world.add_body(kds.box((1, 1, 0.5)), (3, 4, 2), (0, 0, -1))
        events = world.advance_to(10)
        self.assertEqual([(e["kind"], e["time"]) for e in events][:1], [(kds.EventKind.CONTACT, 2.5)])
        np.testing.assert_array_equal(events[0]["normal"], (0, 0, 1))
        with self.assertRaisesRegex(ValueError, "normal.*unit length"):
            kds.half_space((0, 0, 2))
        with self.assertRaisesRegex(ValueError, "fixed"):
            world.add_body(kds.half_space((0, 0, 1)), (0, 0, 0))

    def test_parts_of_a_compound_meet(self):
        world = kds.World()
        table = kds.compound([kds.box((2, 2, 0.25))] + 2 * [kds.box((0.25, 0.25, 1))], [[0, 0, 0], [-1, 0, -1], [1, 0, -1]])
        self.assertEqual(table.kind, "compound")
        world.add_body(table, (0, 0, 0), fixed=True)
        world.add_body(kds.sphere(0.5), (0, 0, -10), (0, 0, 1))  # between the legs, to the top
        world.add_body(kds.sphere(0.5), (1, 0, -10), (0, 0, 1))  # to a leg
        contacts = [e for e in world.advance_to(20) if e["kind"] == kds.EventKind.CONTACT]
        self.assertEqual([(e["time"], e["b"]) for e in contacts], [(7.5, 2), (9.25, 1)])
        turned = kds.compound([kds.box((1, 2, 3))], orientations=(0.5, 0.5, 0.5, 0.5))  # z is where y was
        self.assertAlmostEqual(turned.bounding_radius, kds.box((1, 2, 3)).bounding_radius)
        for parts, message in (
            ([], "has no parts"),
            ([kds.box((1, 1, 1)), kds.sphere(1)], "part 1: is a sphere"),
            ([1], r"parts\[0\]: must be a kds.Shape"),
        ):
            with self.assertRaisesRegex(ValueError, message):
                kds.compound(parts)

    def test_a_compound_that_tumbles(self):
        parts = [kds.box((0.5, 0.0625, 0.0625)), kds.box((0.125, 0.25, 0.125))]
        hammer = kds.compound(parts, [[0, 0, 0], [0.5, 0, 0]], about_centre_of_mass=True)
        world = kds.World(turning=True, response="elastic")
        beside = kds.compound(parts, [[0, 0, 0], [0.5, 0, 0]])
        with self.assertRaisesRegex(ValueError, "inertia: the centre of mass of this compound is at"):
            world.add_body(beside, (0, 0, 0))
        world.add_body(hammer, (0, 0, 0), (1, 0, 0), angular_velocity=(0, 0, 3))
        world.add_body(kds.box((0.5, 2, 2)), (3, 0, 0), fixed=True)
        contacts = [e for e in world.advance_to(4) if e["kind"] == kds.EventKind.CONTACT]
        self.assertGreaterEqual(len(contacts), 1)
        np.testing.assert_allclose(np.abs(contacts[0]["normal"]), (1, 0, 0), atol=1e-12)
        self.assertAlmostEqual(contacts[0]["point"][0], 2.5)

    def test_a_ball_meets_a_terrain(self):
        x, y = np.meshgrid(np.arange(-2, 3), np.arange(-4, 5, 2))
        world = kds.World()
        world.add_body(kds.heightfield(x + 0.0 * y, (1, 2)), (0, 0, 0), fixed=True)  # z = x
        world.add_body(kds.sphere(0.5), (1.25, 1, 5), (0, 0, -1))
        event = world.advance_to(10)[0]
        self.assertAlmostEqual(event["time"], 5 - 1.25 - 0.5 * np.sqrt(2))
        for heights, message in ((np.zeros((1, 5)), "fewer than two rows"), (np.zeros((5, 1)), "columns"),
                                 (np.full((2, 2), np.nan), "finite"), (np.zeros(4), "heights")):
            with self.assertRaisesRegex(ValueError, message):
                kds.heightfield(heights)
        with self.assertRaisesRegex(ValueError, "spacing"):
            kds.heightfield(np.zeros((2, 2)), (0, 1))

    def test_none_is_added_if_one_is_wrong(self):
        world = kds.World()
        radii = np.ones(5)
        radii[3] = -1
        with self.assertRaisesRegex(ValueError, r"bodies\[3\].*radius"):
            world.add_bodies(None, np.zeros((5, 3)), radii=radii)
        self.assertEqual(len(world), 0)
        self.assertEqual(len(world.advance_to(1)), 0)

    def test_masks(self):
        world = kds.World()
        positions = [[0, 0, 0], [3, 0, 0], [3, 5, 0]]
        world.add_bodies(kds.sphere(1), positions, [[1, 0, 0], [0, 0, 0], [0, -1, 0]],
                         categories=[1, 2, 1], collide_with=np.array([1, 3, 3], np.uint32))  # fmt: skip
        met = {(int(e.a), int(e.b)) for e in world.advance_to(10) if e.kind == kds.EventKind.CONTACT}
        self.assertEqual(met, {(1, 2), (0, 2)})

    def test_new_motions(self):
        world = kds.World(degree=2, start_time=1)
        ids = world.add_bodies(kds.sphere(1), np.arange(12).reshape(4, 3) * 10, (1, 2, 3), (0, 0, -1))
        world.advance_to(3)
        world.update_motions(ids[1:3], velocities=[[1, 0, 0], [2, 0, 0]])
        world.update_motion(ids[3], acceleration=(0, 0, 0))
        np.testing.assert_array_equal(world.velocities(), [[1, 2, 1], [1, 0, 0], [2, 0, 0], [1, 2, 1]])
        np.testing.assert_array_equal(world.accelerations()[:, 2], [-1, -1, -1, 0])
        np.testing.assert_array_equal(world.positions([0])[0], [2, 14, 24])
        self.assertEqual(world.now, 3)

    def test_scripts_and_late_entries(self):
        world = kds.World()
        a = world.add_body(kds.sphere(1), (0, 0, 0), then=[kds.Motion(2, (0, 0, 0), (1, 0, 0))])
        b = world.add_body(kds.sphere(1), (4, 0, 0), start=1)
        self.assertEqual(world.bodies.tolist(), [a, b])  # b too, which enters later
        np.testing.assert_array_equal(world.positions(), [[0, 0, 0], [4, 0, 0]])
        self.assertEqual(world.in_box((-9, -9, -9), (9, 9, 9)).tolist(), [a])
        events = world.advance_to(10)
        self.assertEqual([(e.time, e.kind, e.a, e.b) for e in events], [(4, 0, a, b), (8, 1, a, b)])
        self.assertEqual(world.bodies.tolist(), [a, b])

    def test_turning(self):
        world = kds.World(turning=True)
        rod = world.add_body(kds.capsule(0.1, 1), (0, 0, 0), orientation=(1, 0, 0, 0), angular_velocity=(1, 0, 0))
        ball = world.add_body(kds.sphere(0.1), (0, -1, 0))
        (event,) = world.advance_to(2)[:1]
        # The rod's end comes down to the ball's side: its axis is at the distance 0.2 from the ball's centre.
        self.assertAlmostEqual(event.time, np.pi / 2 - np.arcsin(0.2), places=12)
        self.assertEqual((event.a, event.b), (rod, ball))
        half = np.sqrt(0.5)
        world.update_motion(ball, position=(0, 5, 0), orientation=(half, half, 0, 0), angular_velocity=(0, 0, 2))
        np.testing.assert_array_equal(world.angular_velocities([ball])[0], [0, 0, 2])
        np.testing.assert_array_equal(world.orientations([ball])[0], [half, half, 0, 0])

    def test_what_is_kept_of_free_turning(self):
        """A box with three different moments tumbles: its angular momentum stays."""
        world = kds.World(turning=True, response="elastic")
        half, spin, mass = np.array([0.3, 0.6, 1.1]), np.array([0.4, 2.0, 0.3]), 2.5
        box = world.add_body(kds.box(half), (0, 0, 0), angular_velocity=spin, mass=mass)
        moments = mass / 3 * (half @ half - half**2)
        first = world.free_turning(box)
        np.testing.assert_allclose(first.angular_momentum, moments * spin, rtol=1e-14)
        np.testing.assert_allclose(first.angular_velocity, spin, rtol=1e-14)
        farthest = 0.0
        for t in np.linspace(0.25, 8, 32):
            world.advance_to(t)
            turning = world.free_turning(box)
            np.testing.assert_allclose(turning.angular_momentum, first.angular_momentum, rtol=1e-12)
            w, *v = turning.orientation
            self.assertAlmostEqual(w * w + np.dot(v, v), 1, delta=1e-12)
            # Rotated back into the axes of the box, the momentum is its moments times the angular velocity.
            back = [x + 2 * (np.cross(v, np.cross(v, x)) - w * np.cross(v, x))
                    for x in (turning.angular_momentum, turning.angular_velocity)]  # fmt: skip
            np.testing.assert_allclose(back[0], moments * back[1], atol=1e-12)
            self.assertAlmostEqual(turning.angular_momentum @ turning.angular_velocity, (moments * spin) @ spin, delta=1e-11)
            farthest = max(farthest, np.abs(turning.angular_velocity - spin).max())
        self.assertGreater(farthest, 0.5)  # so it did tumble
        with self.assertRaisesRegex(ValueError, "free_turning"):
            world.free_turning(world.add_body(kds.sphere(1), (9, 0, 0), fixed=True))
        flat = kds.World()
        with self.assertRaisesRegex(ValueError, "free_turning: in this world bodies do not turn"):
            flat.free_turning(flat.add_body(kds.sphere(1), (0, 0, 0)))

    def test_where_the_time_goes(self):
        for profile in (False, True):
            world, data = gas(300, 9, profile=profile)
            world.add_bodies(None, **data)
            events = world.advance_to(1)
            self.assertGreater(len(events), 10)
            self.assertEqual(set(world.profile), {"update", "sort", "prune", "test", "other"})
            self.assertEqual(world.profile["test"] > 0, profile)
        with self.assertRaisesRegex(ValueError, "profile: must be False in a world in domains"):
            kds.World(domains=2, profile=True)

    def test_what_turns_meets_a_floor(self):
        world = kds.World(turning=True)
        floor = world.add_body(kds.half_space((0, 0, 1)), (0, 0, 0), fixed=True)
        lying = (np.sqrt(0.5), np.sqrt(0.5), 0, 0)
        rod = world.add_body(kds.capsule(0.1, 1), (0, 0, 1), orientation=lying, angular_velocity=(1, 0, 0))
        (event,) = world.advance_to(2)[:1]
        self.assertAlmostEqual(event.time, np.arcsin(0.9), places=12)
        self.assertEqual((event.a, event.b), (floor, rod))
        with self.assertRaisesRegex(ValueError, "half-space does not turn"):
            world.add_body(kds.half_space((0, 0, 1)), (0, 0, 0), angular_velocity=(1, 0, 0), fixed=True)
        before = world.angular_velocities([rod])
        with self.assertRaisesRegex(ValueError, "half-space does not turn"):
            world.update_motions([rod, floor], angular_velocities=[(0, 0, 3), (0, 0, 1)])
        np.testing.assert_array_equal(world.angular_velocities([rod]), before)


    def test_budgets_change_nothing(self):
        whole, data = gas(300, 8)
        whole.add_bodies(None, **data)
        divided, _ = gas(300, 8)
        divided.add_bodies(None, **data)
        events, calls = [], 0
        while not divided.advance_for(0, 1):
            calls += 1
            events.append(divided.take_events())
        events.append(divided.take_events())
        self.assertEqual(divided.now, 1)
        expected = whole.advance_to(1)
        self.assertGreater(len(expected), 50)
        self.assertGreaterEqual(calls, len(expected))
        self.assertEqual(b"".join(part.tobytes() for part in events), expected.tobytes())
        self.assertTrue(divided.advance_for(60, 1.5))
        for wrong in (-1, np.nan):
            with self.assertRaisesRegex(ValueError, "budget: must be >= 0"):
                divided.advance_for(wrong, 2)
        with self.assertRaisesRegex(ValueError, "advance_for"):
            divided.advance_for(1, 1)  # is over
        with self.assertRaisesRegex(RuntimeError, "in domains goes by advance_to"):
            kds.World(domains=2).advance_for(1, 1)


class Callbacks(unittest.TestCase):
    def test_functions_see_what_is_gathered(self):
        world, data = gas(100, 7)
        world.add_bodies(None, **data)
        seen = []
        for kind in kds.EventKind:
            world.on(kind, lambda event: seen.append(event.tobytes()))
        events = world.advance_to(2)
        self.assertGreater(len(events), 50)
        self.assertEqual(b"".join(seen), events.tobytes())
        plain, _ = gas(100, 7)
        plain.add_bodies(None, **data)
        self.assertEqual(plain.advance_to(2).tobytes(), events.tobytes())

    def test_add_and_remove(self):
        """Each contact replaces both bodies by one: the end is one body of all the mass, where the mass centre is."""
        world, data = gas(60, 3, response="callback")
        ids = world.add_bodies(None, **data)
        masses = dict(zip(ids.tolist(), data["masses"]))

        def merge(event):
            a, b = int(event.a), int(event.b)
            whole = masses[a] + masses[b]
            place = (masses[a] * world.position(a) + masses[b] * world.position(b)) / whole
            velocity = (masses[a] * world.velocity(a) + masses[b] * world.velocity(b)) / whole
            world.remove_body(a)
            world.remove_body(b)
            self.assertNotIn(a, world)
            masses[world.add_body(kds.sphere(0.3), place, velocity, mass=whole)] = whole

        world.on(kds.EventKind.CONTACT, merge)
        world.on(kds.EventKind.OVERLAP, merge)
        world.advance_to(50)
        self.assertLess(len(world), 30)
        self.assertAlmostEqual(sum(world.mass(i) for i in world.bodies), data["masses"].sum(), places=9)
        world.audit()

    def test_exceptions_come_out_and_the_world_goes_on(self):
        world = kds.World()
        world.add_bodies(kds.sphere(1), [[0, 0, 0], [4, 0, 0]], [[1, 0, 0], [0, 0, 0]])

        class Stop(Exception):
            pass

        def stop(event):
            raise Stop(event.time)

        world.on(kds.EventKind.CONTACT, stop)
        with self.assertRaisesRegex(Stop, "2.0"):
            world.advance_to(10)
        self.assertEqual(world.now, 2)
        self.assertEqual(world.take_events().kind.tolist(), [kds.EventKind.CONTACT])
        self.assertEqual(world.advance_to(10).kind.tolist(), [kds.EventKind.SEPARATION])

    def test_a_world_does_not_run_within_its_own_functions(self):
        world = kds.World()
        world.add_bodies(kds.sphere(1), [[0, 0, 0], [4, 0, 0]], [[1, 0, 0], [0, 0, 0]])
        refused = []

        def nested(event):
            for call in (lambda: world.advance_to(5), world.step, world.save):
                with self.assertRaises(RuntimeError) as caught:
                    call()
                refused.append(str(caught.exception))

        world.on(kds.EventKind.CONTACT, nested)
        world.advance_to(10)
        self.assertEqual(len(refused), 3)
        self.assertEqual(refused[0], "World::advance_to: must not be called from within a callback")

    def test_a_world_that_its_functions_hold_is_collected(self):
        world = kds.World()
        world.on(kds.EventKind.CONTACT, lambda event: world)
        watched = weakref.ref(world)
        del world
        gc.collect()
        self.assertIsNone(watched())


class Slotted:
    __slots__ = ("slotted",)


class KeptWorld(Slotted, kds.World):
    def __init__(self, name, **options):
        super().__init__(response="elastic", **options)
        self.name = name


class KeptPeriodicWorld(Slotted, kds.PeriodicWorld):
    pass


class State(unittest.TestCase):
    def test_snapshots(self):
        for turning in (False, True):
            with self.subTest(turning=turning):
                world, data = gas(100, 5, turning=turning)
                world.add_bodies(None, **data)
                world.advance_to(1)
                saved = world.save()
                later = world.advance_to(2)
                self.assertGreater(len(later), 10)
                world.load(saved)
                self.assertEqual(world.now, 1)
                self.assertEqual(world.advance_to(2).tobytes(), later.tobytes())
                world.load(saved)
                for other in (pickle.loads(pickle.dumps(world)), copy.deepcopy(world)):
                    self.assertEqual(other.advance_to(2).tobytes(), later.tobytes())
                for damaged in (saved[:-1], saved[:100] + bytes([saved[100] ^ 1]) + saved[101:], b""):
                    with self.assertRaisesRegex(RuntimeError, "snapshot"):
                        world.load(damaged)
                self.assertEqual(world.advance_to(2).tobytes(), later.tobytes())

    def test_copies_have_the_class_and_the_attributes(self):
        periodic = KeptPeriodicWorld((0, 0, 0), (9, 9, 9))
        for world in (KeptWorld("a name"), KeptWorld("turning", turning=True), KeptWorld("domains", domains=2), periodic):
            world.scores, world.itself, world.ball = {"a": [1]}, world, kds.sphere(0.5)
            world.add_bodies(world.ball, [[1, 1, 1], [5, 1, 1]], [[1, 0, 0], [0, 0, 0]])
            world.slotted = 17
            copies = [copy.copy(world), copy.deepcopy(world)]
            copies += [pickle.loads(pickle.dumps(world, protocol)) for protocol in range(pickle.HIGHEST_PROTOCOL + 1)]
            events = world.advance_to(4)
            self.assertEqual(len(events), 1)
            for other in copies:
                self.assertIs(type(other), type(world))
                self.assertEqual((other.scores, other.slotted, other.now), ({"a": [1]}, 17, 0))
                self.assertIs(other.itself, world if other is copies[0] else other)
                self.assertEqual(other.advance_to(4).tobytes(), events.tobytes())
            self.assertIs(copies[0].scores, world.scores)
            self.assertIsNot(copies[1].scores, world.scores)

    def test_shapes_are_copied_and_pickled(self):
        corners, triangles = np.eye(4, 3) * 2, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]
        shapes = [kds.sphere(0.3), kds.box((1, 2, 3)), kds.capsule(0.1, 2), kds.hull(corners), kds.half_space((0, 0, 1), 2),
                  kds.mesh(corners, triangles, 0.7), kds.heightfield([[0, 1], [1, 0]], (1, 2)),
                  kds.compound([kds.box((1, 1, 1)), kds.hull(corners)], [[0, 0, 0], [3, 0, 0]], (1, 0, 0, 0)),
                  kds.bending_mesh([0, 2], [corners, 2 * corners], triangles)]  # fmt: skip
        for shape in shapes:
            self.assertIs(copy.deepcopy([shape])[0], shape)
            other = pickle.loads(pickle.dumps(shape))
            self.assertEqual((other.kind, other.bounding_radius), (shape.kind, shape.bounding_radius))
            self.assertEqual(pickle.dumps(other), pickle.dumps(shape))
            self.assertEqual(*(kds.shape_distance(each, kds.sphere(1), (4, 5, 6)).distance for each in (shape, other)))

    def test_steps(self):
        world = kds.World()
        world.add_bodies(kds.sphere(1), [[0, 0, 0], [4, 0, 0]], [[1, 0, 0], [0, 0, 0]])
        self.assertTrue(world.next_time <= 2)
        times = []
        while world.step(100):
            times += world.take_events().time.tolist()
        self.assertEqual(times, [2, 6])
        self.assertEqual(world.now, 100)


class Threads(unittest.TestCase):
    def test_other_threads_go_on(self):
        """Another thread counts while the world runs, and is refused the world; with functions it waits for the GIL."""
        world, data = gas(4000, 1, gather=False)
        world.add_bodies(None, **data)
        counted, refused, done = [0], [0], threading.Event()

        def count():
            while not done.is_set():
                counted[0] += 1
                try:
                    world.now
                except RuntimeError:
                    refused[0] += 1

        thread = threading.Thread(target=count)
        thread.start()
        try:
            # Until the other has been refused: a run that kept the GIL would keep it from ever seeing a world that runs.
            begin, t = time.monotonic(), 0.0
            while refused[0] == 0 and time.monotonic() - begin < 30:
                t += 0.5
                world.advance_to(t)
        finally:
            done.set()
            thread.join()
        self.assertGreater(refused[0], 0)
        self.assertGreater(counted[0], refused[0] - 1)


if __name__ == "__main__":
    unittest.main()
