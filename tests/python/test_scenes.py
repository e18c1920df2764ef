"""Scenes: the same as the tool, to the byte."""

import csv
import os
import pickle
import signal
import subprocess
import tempfile
import threading
import unittest

import kds
import numpy as np

TOOL = os.environ["KDS_COLLIDE"]


class Scenes(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.addCleanup(self._folder.cleanup)
        self.folder = self._folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def test_the_events_of_the_tool(self):
        for kind, bodies in (("rings", 200), ("spheres", 300), ("rods", 200)):
            with self.subTest(kind=kind):
                file = self.path(kind + ".json")
                scene = kds.generate_scene(file, kind, bodies, density=0.1, seed=11)
                subprocess.run([TOOL, file, "--events", self.path("tool.csv"), "--quiet"], check=True)
                run = scene.run(csv=self.path("module.csv"))
                with open(self.path("tool.csv"), newline="") as tool, open(self.path("module.csv"), newline="") as module:
                    text = tool.read()
                    self.assertEqual(text, module.read())
                table = list(csv.DictReader(text.splitlines()))
                self.assertGreater(len(table), 20)
                self.assertEqual(len(table), len(run.events))
                self.assertEqual(run.stats["bodies"], bodies)
                for row, event in zip(table, run.events):
                    self.assertEqual(float(row["time"]), event.time)
                    self.assertEqual(row["kind"], kds.EventKind(event.kind).name.lower())
                    self.assertEqual(row["a"], scene.names[event.a])
                    at_wall = event.kind == kds.EventKind.WALL
                    self.assertEqual(row["b"], ("-x", "+x", "-y", "+y", "-z", "+z")[event.b] if at_wall else scene.names[event.b])
                    self.assertEqual([float(row["p" + axis]) for axis in "xyz"], event.point.tolist())
                    self.assertEqual([float(row["n" + axis]) for axis in "xyz"], event.normal.tolist())
                    self.assertEqual(row["feature_a"], kds.feature_name(event.feature_a))
                    self.assertEqual(row["feature_b"], kds.feature_name(event.feature_b))
                # The same bodies in a world that is run step by step, with another broad phase.
                world = scene.world(broad_phase="all-pairs")
                self.assertEqual(len(world), bodies)
                parts = [world.advance_to(t) for t in np.linspace(scene.begin_time, scene.end_time, 7)]
                self.assertEqual(b"".join(part.tobytes() for part in parts), run.events.tobytes())

    def test_replay(self):
        scene = kds.generate_scene(self.path("boxes.json"), "boxes", 20, seed=2)
        file = self.path("replay.html")
        run = scene.run(replay=file, gather=False)
        self.assertEqual(len(run.events), 0)
        subprocess.run([TOOL, self.path("boxes.json"), "--view", self.path("tool.html"), "--quiet"], check=True)
        with open(file, "rb") as module, open(self.path("tool.html"), "rb") as tool:
            self.assertEqual(module.read(), tool.read())

    def test_domains(self):
        scene = kds.generate_scene(self.path("spheres.json"), "spheres", 400, density=0.1, end_time=1.0)
        whole = scene.run()
        self.assertGreater(len(whole.events), 100)
        for domains in (0, 2, 7):
            divided = scene.run(domains=domains, threads=2)
            self.assertEqual(divided.events.tobytes(), whole.events.tobytes())
            if domains > 0:
                self.assertEqual(divided.stats["domains"], domains)
        with self.assertRaisesRegex(ValueError, "domains: must be 1 where there is a replay"):
            scene.run(domains=2, replay=self.path("replay.html"))
        with self.assertRaisesRegex(ValueError, "domains: must be 1 where pairs are told of"):
            scene.run(domains=2, pairs=True)
        self.assertNotIn("profile", whole.stats)
        profiled = scene.run(profile=True)
        self.assertEqual(profiled.events.tobytes(), whole.events.tobytes())
        self.assertGreater(profiled.stats["profile"]["test"], 0)
        with self.assertRaisesRegex(ValueError, "domains: must be 1 where work is profiled"):
            scene.run(domains=2, profile=True)
        with self.assertRaisesRegex(ValueError, "domains: must be a whole number"):
            scene.run(domains=-1)

    def test_heaps(self):
        """Longer flights: fewer contacts."""
        scene = kds.generate_scene(self.path("crates.json"), "crates", 4, seed=3, end_time=0.75)
        self.assertTrue(scene.turning)
        short, long = (len(scene.run(shortest_flight=s).events) for s in (1e-3, 4e-3))
        self.assertLess(long, short)
        whole, divided = (scene.run(domains=domains, threads=2) for domains in (1, 2))
        self.assertEqual(divided.events.tobytes(), whole.events.tobytes())

    def test_bodies_that_turn_in_domains(self):
        scene = kds.generate_scene(self.path("turning.json"), "spinning-rings", 60, density=0.05, seed=3, end_time=3)
        self.assertTrue(scene.turning)
        whole = scene.run()
        self.assertGreater(len(whole.events), 10)
        divided = scene.run(domains=3, threads=2)
        self.assertEqual(divided.events.tobytes(), whole.events.tobytes())
        self.assertEqual(divided.stats["domains"], 3)

    def test_nothing_is_left_behind(self):
        scene = kds.generate_scene(self.path("boxes.json"), "boxes", 5)
        before = sorted(os.listdir(self.folder))
        with self.assertRaisesRegex(ValueError, "broad_phase: there is no \"none\""):
            scene.run(broad_phase="none", csv=self.path("events.csv"))
        with self.assertRaisesRegex(ValueError, "broad_phase: must be one of"):
            scene.world(broad_phase="none")
        with self.assertRaises(OSError):
            scene.run(csv=self.path("no/such/folder.csv"))
        self.assertEqual(sorted(os.listdir(self.folder)), before)

    def test_signals_stay_those_of_the_program(self):
        """Ctrl-C ends a run with KeyboardInterrupt, also after files have been written."""
        scene = kds.generate_scene(self.path("spheres.json"), "spheres", 500, density=0.2, end_time=1e6)
        before = sorted(os.listdir(self.folder))
        for run in (
            lambda: scene.world(gather=False).advance_to(1e6),
            lambda: scene.run(csv=self.path("events.csv"), gather=False, rate=10),
        ):
            timer = threading.Timer(0.2, signal.pthread_kill, (threading.get_ident(), signal.SIGINT))
            timer.start()
            with self.assertRaises(KeyboardInterrupt):
                run()
            timer.join()
            self.assertEqual(sorted(os.listdir(self.folder)), before)

    def test_parts(self):
        scene = kds.generate_scene(self.path("rings.json"), bodies=10, end_time=3)
        self.assertEqual((len(scene), scene.degree, scene.turning, scene.end_time), (10, 1, False, 3))
        self.assertEqual(kds.Scene.read(self.path("rings.json"), until=2).end_time, 2)
        world = scene.world()
        saved = world.save()
        events = world.advance_to(3)
        world.load(saved)
        self.assertEqual(world.advance_to(3).tobytes(), events.tobytes())
        with self.assertRaisesRegex(RuntimeError, "cannot be pickled"):
            pickle.dumps(world)

    def test_mesh_files(self):
        with open(self.path("tetrahedron.obj"), "w") as file:
            file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
        with open(self.path("spoilt.obj"), "w") as file:
            file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2\nf 1 2 3\n")
        with self.assertWarnsRegex(UserWarning, "spoilt.obj: 1 of 2 triangles is degenerate and left out, in line 4"):
            kds.read_mesh(self.path("spoilt.obj"))
        scene = (
            '{"scene": 1, "end_time": 1, "response": "none", "meshes": {"m": {"file": "spoilt.obj"}}, "bodies":'
            ' [{"name": "a", "shape": {"mesh": "m"}, "motion": [{"start": 0, "position": [[0, 0, 0]]}]}]}'
        )
        with self.assertWarnsRegex(UserWarning, "scene.json: meshes.*degenerate"):
            kds.Scene.parse(scene, self.path("scene.json"))
        read = kds.read_mesh(self.path("tetrahedron.obj"), scale=2)
        made = kds.mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], 2)
        self.assertEqual((read.kind, read.bounding_radius), ("mesh", made.bounding_radius))
        times = []
        for shape in (read, made):
            world = kds.World()
            world.add_body(shape, (0, 0, 0))
            world.add_body(kds.sphere(0.5), (0.3, 0.3, 9), (0, 0, -1))
            times.append(world.advance_to(20).tobytes())
        self.assertEqual(*times)
        self.assertGreater(len(times[0]), 0)


if __name__ == "__main__":
    unittest.main()
