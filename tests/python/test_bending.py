"""Meshes that bend: when they meet what, where their vertices are, and what changes them."""

import pickle
import unittest

import kds
import numpy as np

# A mesh may be met early by the margin of its contacts, which is far below this for lengths of the order 1.
MARGIN = 1e-6

CORNERS = np.array([[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]], float)
TRIANGLES = [[0, 1, 2], [0, 2, 3]]


def raised(*heights):
    """The corners of a square at these heights, one after the other."""
    return np.array([CORNERS + [0, 0, height] for height in heights])


def kinds(events):
    return [kds.EventKind(kind).name for kind in events.kind]


class Bending(unittest.TestCase):
    def world_with_sheet(self, times=(0, 2), heights=(0, 2), **options):
        """A square that rises, below a ball whose lowest point is at the height 1.5."""
        world = kds.World(**options)
        sheet = world.add_body(kds.bending_mesh(times, raised(*heights), TRIANGLES), (0, 0, 0), fixed=True)
        ball = world.add_body(kds.sphere(0.5), (0.3, 0.4, 2))
        return world, sheet, ball

    def test_it_meets_a_ball_when_it_has_come_there(self):
        for domains in (1, 2):
            with self.subTest(domains=domains):
                world, sheet, ball = self.world_with_sheet(domains=domains)
                self.assertEqual(world.shape(sheet).kind, "bending mesh")
                event = world.advance_to(5)[0]
                self.assertEqual((kds.EventKind(event.kind).name, event.a, event.b), ("CONTACT", sheet, ball))
                self.assertAlmostEqual(event.time, 1.5, delta=MARGIN)
                self.assertAlmostEqual(event.point[2], 1.5, delta=MARGIN)
                self.assertEqual(kds.feature_name(event.feature_a)[0], "f")

    def test_vertices_move_on_straight_lines_between_keyframes(self):
        random = np.random.default_rng(3)
        times = np.array([1.0, 1.5, 4.0])
        places = random.normal(0, 1, (3, 5, 3))
        world = kds.World()
        sheet = world.add_body(kds.bending_mesh(times, places, [[0, 1, 2], [2, 3, 4]]), (7, 8, 9), (1, 0, 0))
        for t in (0, 1, 1.25, 1.5, 3.5, 4, 6):
            world.advance_to(t)
            expected = [[np.interp(t, times, places[:, i, d]) for d in range(3)] for i in range(5)]
            self.assertLess(np.abs(world.vertices(sheet) - expected).max(), 1e-15 * 16)
        with self.assertRaisesRegex(ValueError, "body 1 is no mesh that bends"):
            world.vertices(world.add_body(kds.sphere(1), (0, 0, 99)))

    def test_what_is_to_come_of_it_may_be_replaced(self):
        world, sheet, _ = self.world_with_sheet()
        world.advance_to(1)
        world.update_vertices(sheet)  # it stands still
        self.assertEqual(len(world.advance_to(3)), 0)
        self.assertTrue(np.array_equal(world.vertices(sheet), raised(1)[0]))
        world.update_vertices(sheet, 5, raised(3)[0])  # from the height 1 at 3 s: 1 a second
        self.assertAlmostEqual(world.advance_to(4)[0].time, 3.5, delta=MARGIN)
        world.update_vertices(sheet, [5, 6], raised(2, 0))
        self.assertEqual(kinds(world.advance_to(9)), ["SEPARATION"])
        self.assertTrue(np.array_equal(world.vertices(sheet), raised(0)[0]))

    def test_a_simulator_gives_the_steps_of_a_whole_script(self):
        times, heights = [0, 0.5, 1, 1.5, 2], [0, 0.6, 0.9, 1.7, 1.8]
        whole, _, _ = self.world_with_sheet(times, heights)
        in_steps, sheet, _ = self.world_with_sheet([0], [0])
        for time, height in zip(times[1:], heights[1:]):
            in_steps.update_vertices(sheet, time, raised(height)[0])
            if time < 2:
                in_steps.advance_for(60, time)
        first, second = whole.advance_to(3), in_steps.advance_to(3)
        self.assertEqual(first.tobytes(), second.tobytes())
        self.assertEqual(kinds(first), ["CONTACT"])

    def test_a_copy_goes_on_in_the_same_way(self):
        world, sheet, _ = self.world_with_sheet()
        world.advance_to(1)
        copy = pickle.loads(pickle.dumps(world))
        self.assertTrue(np.array_equal(copy.vertices(sheet), world.vertices(sheet)))
        self.assertEqual(copy.advance_to(5).tobytes(), world.advance_to(5).tobytes())

    def test_it_meets_itself_if_it_is_asked_to(self):
        # The upper square comes down through the lower one, whose corners are the first four.
        places = np.concatenate([raised(0, 0), 0.5 * CORNERS + np.array([[[0, 0, 1]], [[0, 0, -1]]])], axis=1)
        shape = kds.bending_mesh([0, 2], places, TRIANGLES + [[4, 5, 6], [4, 6, 7]])
        for asked in (False, True):
            world = kds.World()
            body = world.add_body(shape, (0, 0, 0), self_contacts=asked)
            events = world.advance_to(2)
            if not asked:
                self.assertEqual(len(events), 0)
                continue
            self.assertEqual(kinds(events), ["CONTACT", "SEPARATION"])
            self.assertEqual((events[0].a, events[0].b), (body, body))
            self.assertAlmostEqual(events[0].time, 1, delta=MARGIN)
        with self.assertRaisesRegex(ValueError, "self_contacts: a sphere does not bend"):
            world.add_body(kds.sphere(1), (0, 0, 0), self_contacts=True)
        both = world.add_bodies(shape, [[0, 9, 0], [0, 18, 0]], self_contacts=[True, False])
        self.assertEqual(len(both), 2)

    def test_what_is_wrong_is_named(self):
        world, sheet, ball = self.world_with_sheet()
        world.advance_to(1)
        for pattern, call in (
            ("times: must be at least one", lambda: kds.bending_mesh([], np.zeros((0, 4, 3)), TRIANGLES)),
            ("positions: must be of 2 times", lambda: kds.bending_mesh([0, 1], raised(0, 1, 2), TRIANGLES)),
            (r"positions: must have the shape \(n, n, 3\)", lambda: kds.bending_mesh([0], CORNERS, TRIANGLES)),
            ("triangles: must be from 0 to 3, and go from 0 to 4", lambda: kds.bending_mesh(0, CORNERS, [[0, 1, 4]])),
            ("keyframes?.1", lambda: kds.bending_mesh([1, 1], raised(0, 1), TRIANGLES)),
            ("keyframe", lambda: world.update_vertices(sheet, 0.5, CORNERS)),
            ("keyframe", lambda: world.update_vertices(sheet, 2, CORNERS[:3])),
            ("positions: must be none", lambda: world.update_vertices(sheet, [], CORNERS)),
            ("bend", lambda: world.update_vertices(ball, 2, CORNERS)),
            ("no body 77", lambda: world.update_vertices(77, 2, CORNERS)),
        ):
            with self.subTest(pattern=pattern):
                with self.assertRaisesRegex(ValueError, pattern):
                    call()
        self.assertAlmostEqual(world.advance_to(5)[0].time, 1.5, delta=MARGIN)  # and nothing has changed
        with self.assertRaisesRegex(ValueError, "degree|bend"):
            kds.World(degree=3).add_body(kds.bending_mesh(0, CORNERS, TRIANGLES), (0, 0, 0))


if __name__ == "__main__":
    unittest.main()
