# SPDX-License-Identifier: MIT
"""The same scene gives the same bytes for any number of threads, any instruction set, and --no-prune."""
import cli

SCENES = {
    "blend": cli.BLEND,
    "cut": """difference(blend = 0.05) {
  cube(2, center = true);
  for (a = [[0, 0], [90, 0], [0, 90]]) rotate([a[0], a[1], 0]) cylinder(h = 3, r = 0.6, center = true);
}
""",
    "many": """for (i = [0 : 40]) translate([cos(i * 40), sin(i * 40), i / 15])
  sphere(r = 0.2 + 0.004 * i);
""",
    "field": """union(blend = 0.1) {
  intersection() {
    sphere(r = 1);
    field(function (p) 0.3 - abs(sin(400 * p.x) * cos(400 * p.y) + sin(400 * p.y) * cos(400 * p.z)));
  }
  rotate([20, 30, 40]) scale([1, 1.5, 0.7])
    field(function (p) 0.2 - norm([norm([p.x, p.y]) - 0.9, p.z]) + exp(-p.z ^ 2) / 30,
          bounds = [[-1.5, -1.5, -1], [1.5, 0.4, 1]]);
}
""",
}


class SameBytes(cli.CliTest):
    def mesh(self, *arguments, env=None):
        result = self.run_in("a.txt", "-r", "48", "-f", "ply", "-o", "-", *arguments, env=env)
        self.assert_status(result, 0)
        return result.stdout

    def test_threads_pruning_and_instruction_sets(self):
        for name, text in SCENES.items():
            with self.subTest(name):
                self.write("a.txt", text)
                first = self.mesh("-j", "1")
                self.assertGreater(len(first), 10000)
                for arguments in (["-j", "2"], ["-j", "5"], ["--no-prune"]):
                    self.assertEqual(self.mesh(*arguments), first, arguments)
                for isa in ("scalar", "sse2", "avx2", "avx512"):
                    self.assertEqual(self.mesh(env={"CSGMESH_ISA": isa}), first, isa)


if __name__ == "__main__":
    cli.main()
