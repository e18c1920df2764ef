"""Structures for teaching, against brute force between events."""

import unittest

import kds
import numpy as np


def at(coefficients, t):
    """Positions (n, ...) of coefficients (n, k, ...)."""
    return sum(coefficients[:, i] * t**i for i in range(coefficients.shape[1]))


def cross(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def in_circle(a, b, c, d):
    rows = [[*(p - d), (p - d) @ (p - d)] for p in (a, b, c)]
    return np.linalg.det(np.array(rows))


class Structures(unittest.TestCase):
    def test_sorted_list(self):
        for degree in (1, 2):
            with self.subTest(degree=degree):
                random = np.random.default_rng(degree)
                values = random.normal(0, 1, (40, degree + 1))
                line = kds.SortedList(values)
                order = line.order.tolist()
                self.assertEqual(order, np.argsort(values[:, 0]).tolist())
                swaps = 0
                for t in np.linspace(0.1, 4, 30):
                    for time, left, right in line.advance_to(t):
                        place = order.index(right)
                        self.assertEqual(order[place + 1], left)
                        order[place], order[place + 1] = left, right
                        swaps += 1
                        self.assertAlmostEqual(at(values, time)[left], at(values, time)[right], places=9)
                    self.assertEqual(line.order.tolist(), order)
                    self.assertEqual(order, np.argsort(at(values, t)).tolist())
                    np.testing.assert_allclose(line.values, np.sort(at(values, t)), rtol=0, atol=1e-12)
                    line.audit()
                self.assertGreater(swaps, 100)

    def test_edits_of_a_list(self):
        line = kds.SortedList([[0, 1], [5, 0]])
        self.assertEqual(line.next_time, 5)
        third = line.insert([2])
        self.assertEqual(line.order.tolist(), [0, third, 1])
        line.update(third, [9, -1])
        line.remove(1)
        self.assertEqual([tuple(swap) for swap in line.advance_to(10)], [(0, 1, third), (4.5, third, 0)])
        self.assertEqual(len(line), 2)

    def test_hull(self):
        random = np.random.default_rng(5)
        paths = random.normal(0, 1, (12, 3, 2))
        hull = kds.ConvexHull(paths)
        members = set(hull.hull.tolist())
        changes = 0
        for t in np.linspace(0.05, 3, 60):
            for _, change, point, _ in hull.advance_to(t):
                (members.add if change > 0 else members.remove)(point)
                changes += 1
            self.assertEqual(members, set(hull.hull.tolist()))
            points, ring = at(paths, t), hull.hull.tolist()
            np.testing.assert_allclose(hull.positions, points, rtol=0, atol=1e-9)
            for a, b in zip(ring, ring[1:] + ring[:1]):
                self.assertTrue(all(cross(points[a], points[b], points[c]) > 0 for c in range(12) if c not in (a, b)))
        self.assertGreater(changes, 4)
        self.assertGreaterEqual(hull.events, changes)
        hull.audit()

    def test_delaunay(self):
        for degree in (1, 2):
            with self.subTest(degree=degree):
                random = np.random.default_rng(degree)
                paths = random.normal(0, 1, (15, degree + 1, 2))
                net = kds.Delaunay(paths)

                def edges():
                    return {tuple(sorted(map(int, pair))) for t in net.triangles for pair in zip(t, np.roll(t, 1))}

                known = edges()
                changes = 0
                for t in np.linspace(0.05, 2, 25):
                    for _, change, a, b in net.advance_to(t):
                        (known.add if change > 0 else known.remove)((int(a), int(b)))
                        changes += 1
                    self.assertEqual(known, edges())
                    points = at(paths, t)
                    for a, b, c in net.triangles:
                        corners = points[a], points[b], points[c]
                        self.assertGreater(cross(*corners), 0)
                        inside = [d for d in range(15) if d not in (a, b, c) and in_circle(*corners, points[d]) > 1e-9]
                        self.assertEqual(inside, [])
                    self.assertEqual(len(net.triangles), 2 * 15 - 2 - len(net.hull))
                self.assertGreater(changes, 20)
                net.audit()

    def test_edits_of_a_triangulation(self):
        net = kds.Delaunay([[[0, 0]], [[4, 0]], [[0, 4]]])
        self.assertEqual(sorted(net.triangles[0]), [0, 1, 2])
        new = net.insert([[1, 1], [1, 0]])
        self.assertEqual(len(net.triangles), 3)
        net.advance_to(3)  # it has left the triangle at t = 2
        self.assertEqual(net.hull.tolist(), [0, 1, new, 2])
        net.update(new, [[1, 1]])
        self.assertEqual(net.hull.tolist(), [0, 1, 2])
        net.remove(new)
        self.assertEqual(net.ids.tolist(), [0, 1, 2])
        self.assertEqual(len(net.triangles), 1)


if __name__ == "__main__":
    unittest.main()
