# SPDX-License-Identifier: MIT
"""--cells: what a mesh is made from, as a mesh to look at. The boxes are where the statistics say that there is something, features lie on the creases,
a second try of -e leaves nothing of the first, and the mesh keeps its bytes.
"""
import json
import os

import cli

CUT = "difference() { cube(10); translate([10, 10, 10]) sphere(4); }\n"
BAR, BOX = 12, 12 * 12  # triangles of a box, of a frame


class Cells(cli.CliTest):
    def build(self, text, *options):
        """The run's statistics and how many boxes the file has of each kind."""
        self.write("scene.txt", text)
        result = self.run_in("scene.txt", "-o", "out.stl", "--stats", "--cells", "cells.obj", *options)
        self.assert_status(result, 0)
        triangles, name = {}, None
        for line in self.read("cells.obj").decode().splitlines():
            word, *rest = line.split()
            name = rest[0] if word == "o" else name
            triangles[name] = triangles.get(name, 0) + (word == "f")
        del triangles[None]
        return json.loads(result.stdout), {n: count // (BAR if n == "features" else BOX) for n, count in triangles.items()}

    def places(self, part):
        """Positions of the vertices of a part of cells.obj, as lines have them."""
        points, inside = [], False
        for line in self.read("cells.obj").decode().splitlines():
            word, *numbers = line.split()
            inside = numbers == [part] if word == "o" else inside
            if word == "v" and len(numbers) >= 3:
                points.append([float(n) for n in numbers[:3]])
            if word == "f" and inside:
                yield from (points[int(n.split("/")[0]) - 1] for n in numbers)

    def test_equal_cells(self):
        stats, counts = self.build(CUT, "-r", "24")
        mesh = self.read("out.stl")
        self.assertEqual(sorted(counts), ["blocks", "features", "octree"])
        self.assertLessEqual(counts["blocks"], stats["octree"]["leaf_blocks"])  # those that the surface touches
        self.assertGreaterEqual(counts["blocks"], 8)
        self.assertLess(counts["octree"], counts["blocks"])
        self.assertGreaterEqual(counts["features"], stats["features"]["vertices"])
        cell = stats["grid"]["cell_size"]
        for at in self.places("features"):  # near an edge of the cube, or the ball's rim on its faces
            on_planes = sum(min(abs(c), abs(c - 10)) < cell for c in at)
            on_ball = abs(sum((c - 10) ** 2 for c in at) ** 0.5 - 4) < cell
            self.assertGreaterEqual(on_planes + on_ball, 2, at)
        self.assert_status(self.run_in("scene.txt", "-o", "out.stl", "-r", "24", "-q"), 0)
        self.assertEqual(self.read("out.stl"), mesh)

    def test_cells_that_follow_the_shape(self):
        stats, counts = self.build(CUT, "--quality", "draft")
        self.assertEqual(sorted(counts), ["blocks", "octree"])
        self.assertGreater(counts["blocks"], sum(stats["lattice"]["blocks"]) if "blocks" in stats["lattice"] else 100)
        coordinates = list(zip(*self.places("blocks")))
        low, high = map(min, coordinates), map(max, coordinates)
        self.assertTrue(all(value <= 0 for value in low))
        self.assertTrue(all(value >= 10 for value in high))

    def test_tries(self):
        """Of -e with equal cells only the last one is shown."""
        stats, counts = self.build("sphere(10);\n", "-r", "8", "-e", "0.05")
        self.assertLessEqual(counts["blocks"], stats["octree"]["leaf_blocks"])

    def test_alone(self):
        self.write("scene.txt", CUT)
        self.assert_status(self.run_in("scene.txt", "-r", "16", "--cells", "cells.ply"), 0)
        self.assertEqual(sorted(os.listdir(self.folder)), ["cells.ply", "scene.txt"])

    def test_trouble(self):
        self.write("scene.txt", 'sphere(10, $fn = 20);\n')
        result = self.run_in("scene.txt", "--facets=exact", "-o", "out.stl", "--cells", "cells.glb")
        self.assert_status(result, 0)
        self.assertIn("not made from cells", result.stderr)
        self.assertFalse(os.path.exists(self.path("cells.glb")))
        self.assert_refused(self.run_in("scene.txt", "--cells", "scene.txt"), 2, "no format of meshes")
        self.assert_refused(self.run_in("scene.txt", "--cells", "none/a.glb"), 2, "none/a.glb")
        self.write("flat.txt", "square(3);\n")
        result = self.run_in("flat.txt", "-o", "flat.svg", "--cells", "cells.glb")
        self.assert_status(result, 0)
        self.assertIn("--cells has no effect", result.stderr)


if __name__ == "__main__":
    cli.main()
