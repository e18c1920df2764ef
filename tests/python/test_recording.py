"""What worlds record of themselves: pages, animations and surfaces, against what happened."""

import json
import os
import re
import tempfile
import unittest

import kds
import numpy as np


class Recording(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.addCleanup(self._folder.cleanup)

    def path(self, name):
        return os.path.join(self._folder.name, name)

    def replay(self, world, **options):
        """The data of the page."""
        try:
            world.write_replay(self.path("run.html"), **options)
        except RuntimeError as error:
            if "three.js" in str(error):
                self.skipTest(str(error))
            raise
        with open(self.path("run.html"), encoding="utf-8") as page:
            (data,) = re.findall(r'<script id="data" type="application/json">(.*?)</script>', page.read(), re.DOTALL)
        return json.loads(data)

    def place(self, body, t):
        """Where the page draws a body at a time; None if it is not there."""
        pieces = [piece for piece in body["motion"] if piece[0] <= t]
        if not pieces or t >= body.get("until", np.inf):
            return None
        start, *numbers = pieces[-1]
        terms = np.reshape(numbers, (-1, 3))
        return sum(term * (t - start) ** k for k, term in enumerate(terms))

    def test_all_degrees_are_drawn_where_they_are(self):
        kinds = [dict(degree=d) for d in (1, 2, 3, 4, 5)] + [dict(degree=d, turning=True) for d in (1, 2)]
        for kind in kinds:
            with self.subTest(**kind):
                random = np.random.default_rng(5)
                world = kds.World(response="elastic", walls=((0, 0, 0), (12, 12, 12)), record=True, start_time=3, **kind)
                grid = 2.0 + 2.5 * np.stack(np.unravel_index(np.arange(27), (3, 3, 3)), axis=1)
                world.add_bodies(None, grid, random.normal(0, 2, (27, 3)), radii=random.uniform(0.3, 1, 27))
                plain = kds.World(response="elastic", walls=((0, 0, 0), (12, 12, 12)), start_time=3, **kind)
                random = np.random.default_rng(5)
                plain.add_bodies(None, grid, random.normal(0, 2, (27, 3)), radii=random.uniform(0.3, 1, 27))
                places, events = [], []
                for t in np.linspace(3.5, 7, 8):
                    events.append(world.advance_to(t))
                    places.append((t, world.positions()))
                events = np.concatenate(events)
                self.assertEqual(events.tobytes(), plain.advance_to(7).tobytes())  # recording changes nothing
                data = self.replay(world, title="a gas")
                self.assertEqual((data["title"], data["begin"], data["duration"]), ("a gas", 3, 4))
                self.assertEqual(len(data["bodies"]), 27)
                for t, here in places:
                    for body, position in zip(data["bodies"], here):
                        np.testing.assert_allclose(self.place(body, t - 3), position, atol=0.004)
                contacts = events[events["kind"] == kds.EventKind.CONTACT]
                self.assertGreater(len(contacts), 10)
                touches = [touch for touch in data["touches"] if touch[1] == 0]
                self.assertEqual([touch[2:4] for touch in touches], [[e["a"], e["b"]] for e in contacts])
                np.testing.assert_allclose([touch[0] for touch in touches], contacts["time"] - 3, rtol=1e-12)
                self.assertEqual(len(data["walls"]), (events["kind"] == kds.EventKind.WALL).sum())

    def test_what_the_caller_changes(self):
        world = kds.World(record=True)
        stays = world.add_body(kds.box((1, 1, 1)), (0, 0, 0), (1, 0, 0))
        goes = world.add_body(kds.sphere(0.5), (0, 9, 0))
        late = world.add_body(kds.sphere(0.5), (0, -9, 0), start=5, then=[kds.Motion(6, (0, -9, 7))])
        alarm = world.attach_sensor(goes, kds.sphere(1))
        world.advance_to(2)
        world.remove_body(goes)
        world.update_motion(stays, velocity=(0, 2, 0))
        world.set_timer(3)
        world.on(kds.EventKind.TIMER, lambda event: world.add_body(kds.sphere(0.25), (0, 0, 8)))
        self.assertEqual([int(e.kind) for e in world.advance_to(10)], [kds.EventKind.TIMER])  # pieces were not asked for
        data = self.replay(world)
        self.assertEqual(data["title"], "run.html")
        bodies = {body["name"]: body for body in data["bodies"]}
        self.assertEqual(len(bodies), 5)
        named = lambda body: bodies[f"body {body}"]
        self.assertEqual(named(stays)["motion"], [[0, 0, 0, 0, 1, 0, 0], [2, 2, 0, 0, 0, 2, 0]])
        self.assertEqual((named(goes)["until"], named(alarm)["until"]), (2, 2))
        self.assertTrue(named(alarm)["sensor"])
        self.assertEqual(named(late)["motion"], [[5, 0, -9, 0], [6, 0, -9, 7]])
        (new,) = set(bodies) - {f"body {body}" for body in (stays, goes, late, alarm)}
        self.assertEqual(bodies[new]["motion"], [[3, 0, 0, 8]])

    def test_a_state_that_is_loaded(self):
        world = kds.World(record=True)
        world.add_body(kds.sphere(1), (0, 0, 0), (1, 0, 0))
        world.advance_to(2)
        saved = world.save()
        world.update_motion(0, velocity=(0, 5, 0))
        world.advance_to(9)
        world.load(saved)
        world.advance_to(3)
        data = self.replay(world)
        self.assertEqual((data["begin"], data["duration"]), (2, 1))
        np.testing.assert_array_equal(self.place(data["bodies"][0], 1), (3, 0, 0))

    def test_animations_and_surfaces(self):
        world = kds.World(record=True)
        world.add_body(kds.sphere(1), (0, 0, 0), (1, 0, 0))
        world.add_body(kds.box((1, 2, 3)), (20, 0, 0))
        world.advance_to(2)
        world.write_gltf(self.path("run.gltf"), "two")
        with open(self.path("run.gltf"), encoding="utf-8") as file:
            gltf = json.load(file)
        self.assertEqual(gltf["asset"]["version"], "2.0")
        self.assertLessEqual({"body 0", "body 1"}, {node.get("name") for node in gltf["nodes"]})
        world.write_vtk(self.path("run.pvd"), frames_per_second=2)
        self.assertEqual(sorted(os.listdir(self.path("run.frames"))), [f"frame_{i}.vtp" for i in range(5)])
        with open(self.path("run.pvd"), encoding="utf-8") as series:
            self.assertEqual(series.read().count("<DataSet"), 5)

    def test_periodic_boxes(self):
        for degree in (1, 2):
            world = kds.PeriodicWorld((0, 0, 0), (8, 8, 8), degree, record=True)
            world.add_bodies(kds.sphere(0.5), [[1, 4, 4], [7, 4, 4], [4, 1, 1]], [[-1, 0, 0], [1, 0, 0], [0, 1, 0]])
            places = []
            for t in range(1, 9):
                world.advance_to(t)
                places.append((t, world.positions()))
            data = self.replay(world)
            self.assertEqual(data["domain"]["max"], [8, 8, 8])
            self.assertEqual([touch[0] for touch in data["touches"]], [0.5, 3.5, 6.5])
            for t, here in places:
                for body, position in zip(data["bodies"], here):
                    np.testing.assert_allclose(self.place(body, t), position, atol=1e-6)

    def test_scenes(self):
        scene = kds.generate_scene(self.path("boxes.json"), "boxes", 20, density=0.1, seed=2)
        world = scene.world(record=True)
        events = world.advance_to(scene.end_time)
        run = scene.run()
        self.assertEqual(events.tobytes(), run.events.tobytes())
        self.assertEqual(len(self.replay(world)["bodies"]), 20)

    def test_what_is_refused(self):
        world = kds.World()
        for write in (
            lambda: world.write_replay(self.path("run.html")),
            lambda: world.write_gltf(self.path("run.gltf")),
            lambda: world.write_vtk(self.path("run.pvd")),
            lambda: kds.PeriodicWorld((0, 0, 0), (8, 8, 8)).write_gltf(self.path("run.gltf")),
        ):
            with self.assertRaisesRegex(RuntimeError, "made with record=True"):
                write()
        self.assertEqual(os.listdir(self._folder.name), [])
        with self.assertRaisesRegex(ValueError, "record: must be False in a world in domains"):
            kds.World(domains=2, record=True)
        recorded = kds.World(record=True)
        recorded.add_body(kds.sphere(1), (0, 0, 0))
        with self.assertRaisesRegex(ValueError, "frames a second"):
            recorded.write_gltf(self.path("run.gltf"), frames_per_second=0)
        with self.assertRaisesRegex(ValueError, "pvd"):
            recorded.write_vtk(self.path("run.vtk"))
        with self.assertRaises(OSError):
            recorded.write_gltf(self.path("nowhere/run.gltf"))


if __name__ == "__main__":
    unittest.main()
