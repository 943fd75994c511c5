# SPDX-License-Identifier: Apache-2.0
"""Each style check finds what it is there to find, and leaves a right tree alone."""
import unittest

from check_definitions import check_definitions
from check_includes import check_includes
from check_names import check_names
from check_text import check_text


class IncludeRule(unittest.TestCase):
    def judge(self, path, include):
        return check_includes({path: f"#include {include}\n"})

    def test_allowed(self):
        for path, include in (
                ("solver/state/grid.c", '"math/tensor.h"'),
                ("solver/explicit/step.c", '"materials/material.h"'),
                ("solver/scene/parse.c", "<jansson.h>"),
                ("solver/output/frame.c", "<hdf5.h>"),
                ("server/store.c", '"talus/status.h"'),
                ("server/store.c", '"base/protocol.h"')):
            self.assertEqual(self.judge(path, include), [], (path, include))

    def test_refused(self):
        for path, include in (
                ("solver/math/tensor.c", '"state/grid.h"'),
                ("solver/materials/j2.c", '"shapes/shape.h"'),
                ("solver/shapes/linear.c", '"materials/material.h"'),
                ("solver/boundaries/slip.c", '"explicit/step.h"'),
                ("solver/explicit/step.c", '"output/frame.h"'),
                ("solver/unknown/file.c", '"base/status.h"'),
                ("solver/explicit/step.c", "<jansson.h>"),
                ("solver/worker/main.c", "<hdf5.h>"),
                ("server/jobs.c", '"talus/simulation.h"'),
                ("server/jobs.c", '"scene/scene_json.h"'),
                ("server/jobs.c", "<cairo.h>"),
                ("clients/cli/main.c", "<microhttpd.h>"),
                ("include/talus/scene.h", '"base/parameter.h"')):
            self.assertEqual(len(self.judge(path, include)), 1, (path, include))


class OtherRules(unittest.TestCase):
    def test_names(self):
        self.assertEqual(check_names({"a/main.c": "", "b/main.c": "", "a/x.c": ""}), [])
        self.assertEqual(len(check_names({"a/x.c": "", "b/x.c": ""})), 1)

    def test_text(self):
        spdx = "/* SPDX-License-Identifier: Apache-2.0 */\n"
        self.assertEqual(check_text({"a.c": spdx + "/* Mast 2013, eq. 4.29 */\n"}), [])
        self.assertEqual(check_text({"CMakeLists.txt": "# " + spdx + "add(x INTERFACE y)\n"}), [])
        for text in ("int a;\n", spdx + "int a; \n", spdx + "int a;", spdx + "/home/someone/x\n",
                     spdx + "/* THEORY 3.2 */\n", spdx + "/* see NOTES.md */\n"):
            self.assertEqual(len(check_text({"a.c": text})), 1, text)

    def test_definitions(self):
        listed = {"solver/materials/materials.def": "MATERIAL(j2)\n",
                  "solver/materials/j2.c": "const struct material j2 = {\n"}
        self.assertEqual(check_definitions(listed), [])
        without_file = {"solver/materials/materials.def": "MATERIAL(j2)\n"}
        self.assertEqual(len(check_definitions(without_file)), 1)
        without_line = dict(listed)
        without_line["solver/materials/tresca.c"] = "const struct material tresca = {\n"
        self.assertEqual(len(check_definitions(without_line)), 1)
        routes = {"server/routes.def": 'ROUTE(GET, "v1/jobs/*", QUICK, READ, job)\n',
                  "server/handlers/handle_job.c": "enum handled handle_job(struct request *r)\n"}
        self.assertEqual(check_definitions(routes), [])
        routes["server/handlers/handle_log.c"] = "enum handled handle_log(struct request *r)\n"
        self.assertEqual(len(check_definitions(routes)), 1)
        del routes["server/handlers/handle_job.c"]
        self.assertEqual(len(check_definitions(routes)), 2)
        self.assertEqual(len(check_definitions({"solver/new.def": "X(y)\n"})), 1)


if __name__ == "__main__":
    unittest.main()
