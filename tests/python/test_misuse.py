"""Wrong arguments are refused by name, and nothing is half done."""

import math
import os
import tempfile
import unittest

import kds
import numpy as np


class Misuse(unittest.TestCase):
    def refused(self, pattern, call, error=ValueError):
        with self.assertRaisesRegex(error, pattern):
            call()

    def setUp(self):
        self.world = kds.World()
        self.ball = kds.sphere(1)

    def tearDown(self):
        self.assertEqual(len(self.world), 0)

    def test_shapes_of_arrays(self):
        w, n3 = self.world, np.zeros((4, 3))
        self.refused(r"positions: must have the shape \(n, 3\), and has \(4, 2\)", lambda: w.add_bodies(self.ball, n3[:, :2]))
        self.refused(r"positions: must have the shape", lambda: w.add_bodies(self.ball, [1, 2, 3]))
        self.refused(r"velocities: must have the shape \(4, 3\), and has \(3, 3\)",
                     lambda: w.add_bodies(self.ball, n3, n3[:3]))  # fmt: skip
        self.refused(r"masses: must have the shape \(4,\)", lambda: w.add_bodies(self.ball, n3, masses=[1, 2]))
        self.refused(r"orientations: .*\(4, 4\)", lambda: w.add_bodies(self.ball, n3, orientations=n3))
        self.refused(r"radii: must have", lambda: w.add_bodies(None, n3, radii=n3))
        self.refused(r"position: must have the shape \(3,\)", lambda: w.add_body(self.ball, (1, 2)))
        self.refused(r"shapes: must be a kds.Shape or 4", lambda: w.add_bodies([self.ball] * 3, n3))
        self.refused(r"shapes: must be given, or else radii", lambda: w.add_bodies(None, n3))
        self.refused(r"shapes: must be given, or else radii", lambda: w.add_bodies(self.ball, n3, radii=1))

    def test_points_of_hulls(self):
        self.refused(r"^points: has 3 points; a solid takes at least 4$", lambda: kds.hull(np.eye(3)))
        self.refused(r"^points: has no volume: all points lie in a plane$", lambda: kds.hull(np.eye(5, 3)[:, [0, 1, 1]]))
        self.refused(r"^points: point 3: must be finite$", lambda: kds.hull(np.diag([1, 1, 1, np.nan])[:, [0, 1, 3]]))

    def test_types(self):
        w, n3 = self.world, np.zeros((4, 3))
        self.refused(r"positions: must be real numbers, and has the dtype complex128", lambda: w.add_bodies(self.ball, n3 + 1j))
        self.refused(r"position: must be real numbers", lambda: w.add_body(self.ball, ("a", "b", "c")))
        self.refused(r"position: must be", lambda: w.add_body(self.ball, (0, 0, None)))
        self.refused(r"mass: must be a number", lambda: w.add_body(self.ball, (0, 0, 0), mass="heavy"))
        self.refused(r"shape: must be a kds.Shape, and is 1", lambda: w.add_body(1, (0, 0, 0)))
        self.refused(r"fixed: must be bools", lambda: w.add_bodies(self.ball, n3, fixed=[0, 1, 0, 1]))
        self.refused(r"categories: must be whole numbers", lambda: w.add_bodies(self.ball, n3, categories=1.5))
        self.refused(r"collides_with: must be numbers of 32 bits", lambda: w.add_body(self.ball, (0, 0, 0), collides_with=2**32))
        self.refused(r"then\[0\]: must be a kds.Motion", lambda: w.add_body(self.ball, (0, 0, 0), then=[3]))
        self.refused(r"body: must be the id of a body", lambda: w.remove_body("a"))
        self.refused(r"bodies: must be ids", lambda: w.positions([1.0]))
        self.refused(r"snapshot: must be bytes", lambda: w.load("text"))
        self.refused(r"function: must be callable", lambda: w.on(kds.EventKind.WALL, 3))
        self.refused(r"kind: must be a kds.EventKind, and is 99", lambda: w.on(99, print))

    def test_masked_arrays(self):
        w, places = self.world, np.zeros((4, 3))
        hidden = np.ma.masked_array(places, mask=places == 0)
        self.refused("^positions: has entries that are masked$", lambda: w.add_bodies(self.ball, hidden))
        self.refused("^positions: has entries that are masked$", lambda: w.add_bodies(self.ball, list(hidden)))
        self.refused("^velocities: has entries that are masked$", lambda: w.add_bodies(self.ball, places, hidden))
        self.refused("^masses: has entries that are masked$", lambda: w.add_bodies(self.ball, places, masses=hidden[:, 0]))
        self.refused("^mass: must be a number", lambda: w.add_body(self.ball, (0, 0, 0), mass=hidden[0, 0]))
        self.refused("^position: has entries that are masked$", lambda: w.add_body(self.ball, (0, np.ma.masked, 0)))
        self.refused("^bodies: has entries that are masked$",
                     lambda: w.positions(np.ma.masked_array([0, 1], mask=[0, 1])))  # fmt: skip
        self.refused("^coefficients: has entries that are masked$", lambda: kds.SortedList(hidden))
        whole = kds.World()
        self.assertEqual(len(whole.add_bodies(self.ball, np.ma.masked_array(3.0 * np.eye(3)))), 3)  # nothing is hidden

    def test_nothing_of_a_wrong_type_gets_through(self):
        """Each argument of each function in turn is of a type that fits nowhere: one line says so, and names it."""
        zero, world = (0, 0, 0), kds.World(degree=2)
        a, b = world.add_bodies(self.ball, [[0, 0, 0], [9, 0, 0]])
        periodic = kds.PeriodicWorld(zero, (9, 9, 9))
        line, net = kds.SortedList([[0, 1], [1, 0]]), kds.Delaunay(np.eye(3, 2)[:, None])
        scene = kds.Scene.parse('{"scene": 1, "end_time": 1, "response": "none", "bodies": []}')
        tried = 0
        for function, given in (
            (kds.World, dict(degree=1, turning=False, response="none", walls=None, wall_restitution=1, broad_phase="auto",
                             report_pairs=False, report_pieces=False, gather=True, start_time=0, window=1, rate=0,
                             kdop=6, threads=1, zeno_contacts=100, zeno_interval=0, shortest_flight=1,
                             orientation_error=0.01, most_edits=1, domains=1, profile=False)),
            (kds.PeriodicWorld, dict(low=zero, high=(9, 9, 9), degree=1, boundaries="periodic", shear_rate=0,
                                     wall_restitution=1, wall_temperatures=np.zeros(6), seed=1, elastic_within=0,
                                     broad_phase="auto", gather=True, start_time=0, window=1, threads=1)),
            (kds.Motion.through, dict(times=[0, 1], positions=[zero, zero], velocities=[zero, zero],
                                      accelerations=[zero, zero])),
            (periodic.add_bodies, dict(shapes=self.ball, positions=[zero], velocities=zero, accelerations=zero, higher=())),
            (periodic.step, dict(limit=1)),
            (periodic.crossings, dict(bodies=[])),
            (periodic.unwrapped_positions, dict(bodies=[])),
            (kds.sphere, dict(radius=1)),
            (kds.box, dict(half_extents=(1, 1, 1))),
            (kds.capsule, dict(radius=1, half_length=1)),
            (kds.hull, dict(points=np.eye(4, 3))),
            (kds.half_space, dict(normal=(0, 0, 1), offset=1)),
            (kds.compound, dict(parts=[kds.box((1, 1, 1))], positions=zero, orientations=(1, 0, 0, 0),
                                about_centre_of_mass=True)),
            (kds.heightfield, dict(heights=np.zeros((2, 2)), spacing=(1, 1))),
            (kds.mesh, dict(vertices=np.eye(3), triangles=[[0, 1, 2]], scale=1)),
            (kds.bending_mesh, dict(times=[0, 1], positions=np.zeros((2, 3, 3)), triangles=[[0, 1, 2]])),
            (kds.shape_distance, dict(a=self.ball, b=self.ball, position=zero, orientation_a=(1, 0, 0, 0),
                                      orientation_b=(1, 0, 0, 0), time=0)),
            (kds.read_mesh, dict(file="no-such-file.obj", scale=1)),
            (kds.Scene.read, dict(file="no-such-file.json", until=1)),
            (kds.Scene.parse, dict(text="", file="scene.json", until=1)),
            (kds.generate_scene, dict(file="", kind="rings", bodies=1, density=0.1, seed=1, end_time=1)),
            (scene.run, dict(broad_phase="auto", rate=0, kdop=6, pairs=False, threads=1, gather=True, profile=False,
                             csv=None, replay=None)),
            (scene.world, dict(gather=True, broad_phase="auto")),
            (world.add_body, dict(shape=self.ball, position=zero, velocity=zero, acceleration=zero, start=0, higher=(),
                                  orientation=(1, 0, 0, 0), angular_velocity=zero, then=(), mass=1, inertia=1,
                                  fixed=False, restitution=1, friction=0, tangential_restitution=0,
                                  rolling_friction=0, category=1, collides_with=1, sensor=False, self_contacts=False,
                                  user_data=0)),
            (world.add_bodies, dict(shapes=self.ball, positions=[zero], velocities=zero, accelerations=zero, starts=0, higher=(), then=(),
                                    orientations=(1, 0, 0, 0), angular_velocities=zero, masses=1, inertias=1,
                                    fixed=False, restitutions=1, frictions=0, tangential_restitutions=0,
                                    rolling_frictions=0, categories=1, collide_with=1, sensors=False, self_contacts=False,
                                    user_data=0)),
            (world.add_bodies, dict(shapes=None, positions=[zero], radii=1)),
            (world.remove_body, dict(body=99)),
            (world.update_motion, dict(body=a, position=zero, velocity=zero, acceleration=zero, higher=(), then=())),
            (world.update_motions, dict(bodies=[a], positions=zero, velocities=zero, accelerations=zero, higher=(),
                                        then=())),
            (world.append_motion, dict(body=a, motion=())),
            (world.update_vertices, dict(body=a, times=[2], positions=np.zeros((1, 3, 3)))),
            (world.vertices, dict(body=a)),
            (world.free_turning, dict(body=a)),
            (world.set_mass, dict(bodies=a, mass=1)),
            (world.set_restitution, dict(bodies=a, restitution=1)),
            (world.set_filter, dict(bodies=a, category=1, collides_with=1)),
            (world.set_user_data, dict(bodies=a, user_data=1)),
            (world.positions, dict(bodies=[a])),
            (world.higher, dict(bodies=[a])),
            (world.position, dict(body=a)),
            (world.velocity, dict(body=a)),
            (world.shape, dict(body=a)),
            (world.mass, dict(body=a)),
            (world.fixed, dict(body=a)),
            (world.sensor, dict(body=a)),
            (world.restitution, dict(body=a)),
            (world.category, dict(body=a)),
            (world.collides_with, dict(body=a)),
            (world.user_data, dict(body=a)),
            (world.advance_to, dict(t=0)),
            (world.step, dict(limit=0)),
            (world.on, dict(kind=kds.EventKind.WALL, function=None)),
            (world.set_timer, dict(t=1)),
            (world.cancel_timer, dict(timer=1)),
            (world.load, dict(snapshot=b"")),
            (world.in_box, dict(low=zero, high=zero)),
            (world.cast, dict(start=zero, end=(1, 0, 0), shape=self.ball, orientation=(1, 0, 0, 0), filter=None)),
            (world.cast_all, dict(start=zero, end=(1, 0, 0), shape=None, orientation=(1, 0, 0, 0), filter=None)),
            (world.overlapping, dict(shape=self.ball, position=zero, orientation=(1, 0, 0, 0), filter=None)),
            (world.nearest, dict(point=zero, count=1, filter=None)),
            (world.next_contact, dict(shape=self.ball, position=zero, velocity=zero, acceleration=zero, until=1,
                                      orientation=(1, 0, 0, 0), angular_velocity=zero, higher=(), filter=None)),
            (world.next_contact_of, dict(body=a, until=1, filter=None)),
            (world.next_contact_between, dict(a=a, b=b, until=1)),
            (world.closest_approach, dict(a=a, b=b, until=1)),
            (world.distance_between, dict(a=a, b=b)),
            (world.partners, dict(body=a)),
            (world.touching, dict(a=a, b=b)),
            (world.resting, dict(a=a, b=b)),
            (world.resting_at_wall, dict(body=a, wall=0)),
            (kds.SortedList, dict(coefficients=[[0]], start=0)),
            (kds.Delaunay, dict(paths=np.eye(3, 2)[:, None], start=0)),
            (line.advance_to, dict(t=0)),
            (line.insert, dict(coefficients=[0])),
            (line.update, dict(element=0, coefficients=[0])),
            (line.remove, dict(element=9)),
            (net.advance_to, dict(t=0)),
            (net.insert, dict(coefficients=[[0, 0]])),
            (net.update, dict(element=0, coefficients=[[0, 0]])),
            (net.remove, dict(element=9)),
        ):  # fmt: skip
            for name in given:
                for wrong in (object(), [object()], "no", [[1], [1, 2]], {1: 2}, 1j):
                    if isinstance(wrong, str) and (isinstance(given[name], str) or name in ("csv", "replay")):
                        continue
                    with self.subTest(function=function.__qualname__, name=name, wrong=wrong):
                        with self.assertRaises(ValueError) as caught:
                            function(**{**given, name: wrong})
                        text = str(caught.exception)
                        self.assertRegex(text, rf"^{name}\b")
                        self.assertNotIn("\n", text)
                        tried += 1
        self.assertGreater(tried, 900)
        self.assertEqual(len(world), 2)

    def test_values(self):
        w = self.world
        self.refused("radius", lambda: kds.sphere(-1))
        self.refused("radius", lambda: kds.sphere(math.nan))
        self.refused("half_extents", lambda: kds.box((1, 0, 1)))
        self.refused("mass", lambda: w.add_body(self.ball, (0, 0, 0), mass=0))
        self.refused("restitution", lambda: w.add_body(self.ball, (0, 0, 0), restitution=2))
        self.refused("finite", lambda: w.add_body(self.ball, (0, 0, math.inf)))
        self.refused("orientation", lambda: w.add_body(self.ball, (0, 0, 0), orientation=(1, 1, 0, 0)))
        self.refused("acceleration: must be 0 in a world of degree 1", lambda: w.add_body(self.ball, (0, 0, 0), (0, 0, 0), (1, 0, 0)))
        self.refused("angular_velocity: must be 0 in a world that is not turning",
                     lambda: w.add_body(self.ball, (0, 0, 0), angular_velocity=(1, 0, 0)))  # fmt: skip
        self.refused(r"triangles: must be from 0 to 2", lambda: kds.mesh(np.eye(3), [[0, 1, 3]]))
        self.refused(r"triangles: must be whole numbers", lambda: kds.mesh(np.eye(3), [[0.0, 1, 2]]))
        self.refused("no-such-file.obj: ", lambda: kds.read_mesh("no-such-file.obj"))

    def test_options(self):
        self.refused(r"degree: must be 1 \(lines\), 2 .* or up to 5 .*, not 6", lambda: kds.World(6))
        self.refused("degree: must be 1 .* where bodies turn, not 3", lambda: kds.World(3, True))
        self.refused("degree: must be 1 .* or up to 5 .*, not 6", lambda: kds.World(6, domains=2))
        self.refused("degree: must be 1 .* where bodies turn, not 3", lambda: kds.World(3, True, domains=0))
        self.refused("response", lambda: kds.World(domains=2, response="callbac"))
        self.refused("report_pairs: must be False in a .* in domains", lambda: kds.World(domains=2, report_pairs=True))
        self.refused("report_pieces: must be False in a .* in domains", lambda: kds.World(domains=0, report_pieces=True))
        self.refused("degree: must be a whole number", lambda: kds.World(1.5))
        self.refused("turning: must be True or False", lambda: kds.World(1, 2))
        self.refused("response: must be a string", lambda: kds.World(response=None))
        self.refused("kdop", lambda: kds.World(kdop=7))
        self.refused("zeno_contacts: must be a whole number from 0 to 4294967295", lambda: kds.World(zeno_contacts=2**32))
        self.refused("response: must be 'none', 'elastic' or 'callback', not 'soft'", lambda: kds.World(response="soft"))
        self.refused("broad_phase: must be one of 'auto'.*not 'bvh'", lambda: kds.World(broad_phase="bvh"))
        self.refused(r"walls: must have the shape \(2, 3\)", lambda: kds.World(walls=((0, 0), (1, 1))))
        self.refused("walls", lambda: kds.World(walls=((0, 0, 0), (1, -1, 1))))
        self.refused("window", lambda: kds.World(window=-1))
        self.refused("unexpected keyword", lambda: kds.World(gravity=1), TypeError)

    def test_time(self):
        w = self.world
        w.advance_to(2)
        for t in (1, math.nan, math.inf):
            self.refused("advance_to: the time must be finite and not before now, which is 2", lambda: w.advance_to(t))
        self.assertEqual(w.now, 2)

    def test_bodies_that_are_not_there(self):
        w = self.world
        body = w.add_body(self.ball, (0, 0, 0))
        kept = w.add_body(self.ball, (9, 0, 0))
        w.remove_body(body)
        self.assertNotIn(body, w)
        self.assertNotIn(77, w)
        for call in (
            lambda: w.remove_body(body),
            lambda: w.position(body),
            lambda: w.update_motion(body, velocity=(1, 0, 0)),
            lambda: w.update_motions([kept, body], velocities=(1, 0, 0)),
            lambda: w.closest_approach(body, kept, until=1),
            lambda: w.distance_between(kept, body),
            lambda: w.next_contact_of(body, until=1),
        ):
            self.refused(f"{body}.*removed", call)
        self.refused("77", lambda: w.mass(77))
        self.assertEqual(w.velocity(kept).tolist(), [0, 0, 0])
        again = w.add_body(self.ball, (0, 0, 0))
        self.assertNotEqual(again, body)
        self.refused("removed", lambda: w.position(body))
        w.remove_body(again)
        w.remove_body(kept)

    def test_motions_change_all_or_none(self):
        w = kds.World()
        ids = w.add_bodies(self.ball, np.arange(9).reshape(3, 3) * 5)
        self.refused(r"motion of body 2: must be finite",
                     lambda: w.update_motions(ids, velocities=[[1, 0, 0], [1, 0, 0], [math.nan, 0, 0]]))  # fmt: skip
        self.assertFalse(w.velocities().any())
        self.refused("orientation: bodies keep theirs", lambda: w.update_motion(ids[0], orientation=(1, 0, 0, 0)))

    def test_scenes(self):
        self.refused(r"scene.json: bodies\[0\].shape.sphere.radius: must be > 0", lambda: kds.Scene.parse(
            '{"scene": 1, "end_time": 1, "response": "none", "bodies": [{"name": "a", "shape": {"sphere": {"radius": 0}},'
            ' "motion": [{"start": 0, "position": [[0, 0, 0]]}]}]}'))  # fmt: skip
        self.refused("no-such-file.json", lambda: kds.Scene.read("no-such-file.json"))
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "latin-1.json")
            with open(path, "wb") as file:
                file.write('{"größe": 1}'.encode("latin-1"))
            self.refused("latin-1.json: document: line 1, column 5: .*ill-formed UTF-8 byte", lambda: kds.Scene.read(path))
        self.refused("bodies", lambda: kds.generate_scene("unused.json", bodies=0))

    def test_structures(self):
        self.refused(r"coefficients: must have the shape \(n, k\), k from 1 to 3, and has \(2, 4\)", lambda: kds.SortedList(np.zeros((2, 4))))
        self.refused(r"coefficients\[1\]: must be finite", lambda: kds.SortedList([[0, 1], [math.nan, 2]]))
        self.refused(r"paths: must have the shape \(n, k, 2\)", lambda: kds.Delaunay(np.zeros((5, 2))))
        line = kds.SortedList([[0, 1], [1, 0]])
        self.refused("no element with id 5", lambda: line.remove(5))
        line.advance_to(2)
        self.refused("not before now, which is 2", lambda: line.advance_to(1))


if __name__ == "__main__":
    unittest.main()
