# SPDX-License-Identifier: MIT
"""What the tests of csgmesh diff share: meshes of small scenes, and comparisons of them."""
import json
import os

import cli


class DiffTest(cli.CliTest):
    RESOLUTION = 32

    def mesh(self, text, name, *options):
        """Meshes the text; nothing but the mesh is left in the folder."""
        self.write("scene.txt", text)
        os.makedirs(os.path.dirname(self.path(name)) or ".", exist_ok=True)
        self.assert_status(self.run_in("scene.txt", "-o", name, "-r", self.RESOLUTION, "-q", *options), 0)
        os.unlink(self.path("scene.txt"))

    def diff(self, status, *arguments):
        samples = () if "--samples" in arguments else cli.FEW_SAMPLES
        result = self.run_in("diff", *arguments, *samples)
        self.assert_clean(result)
        self.assert_status(result, status)
        return result

    def report(self, status, *arguments):
        return json.loads(self.diff(status, *arguments, "--json", "-").stdout)
