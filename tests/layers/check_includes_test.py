"""Puts one include at a time into a small tree and looks whether check_includes.py finds it."""

import tempfile
import unittest
import unittest.mock
from pathlib import Path

import check_includes
from check_includes import unused_allowances, violations

ROOT = Path(__file__).resolve().parents[2]


class CheckIncludes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)

    def found(self, files, internal=()):
        """Violations of a tree with these files, each with one include as written after #include."""
        for name, include in files.items():
            path = self.root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(f"#pragma once\n\n#include {include}\n", encoding="utf-8")
        return violations(self.root, internal)

    def expect_only_the_first_to_be_refused(self, cases):
        for name, include in cases:
            with self.subTest(name=name, include=include):
                self.assertEqual(1, len(self.found({name: include})))
                self.assertEqual([], self.found({name: "<vector>"}))

    def test_accepts_the_direction_of_the_layers(self):
        self.assertEqual(
            [],
            self.found(
                {
                    "prowl/model/robot.hpp": "<Eigen/Core>",
                    "prowl/model/robot.cpp": '"prowl/model/pinocchio_model.hpp"',
                    "prowl/model/pinocchio_model.hpp": "<pinocchio/multibody/model.hpp>",
                    "prowl/model/urdf/outline.cpp": '"prowl/model/robot.hpp"',
                    "prowl/dynamics/terms.cpp": "<pinocchio/algorithm/rnea.hpp>",
                    "prowl/motion/cost.hpp": '"prowl/dynamics/terms.hpp"',
                    "prowl/transcription/node/functions.cpp": '"prowl/nlp/nlp.hpp"',
                    "prowl/solvers/foreign/ipopt_solver.cpp": "<IpTNLP.hpp>",
                    "prowl/nlp/nlp.cpp": '"prowl/error.hpp"',
                    "prowl/plan.cpp": '"prowl/mesh/mesh.hpp"',
                    "prowl/session/plan_task.hpp": '"prowl/plan.hpp"',
                    "screen/summary.cpp": '"prowl/plan_folder/plan_folder.hpp"',
                    "cli/verbs/plan_command.cpp": '"screen/summary.hpp"',
                    "cli/main.cpp": '"cli/verbs/commands.hpp"',
                    "python/src/task.cpp": '"prowl/task_file/task.hpp"',
                },
                internal=["prowl/model/pinocchio_model.hpp"],
            ),
        )

    def test_refuses_each_step_against_it(self):
        self.expect_only_the_first_to_be_refused(
            [
                ("prowl/model/robot.hpp", '"prowl/motion/cost.hpp"'),
                ("prowl/model/urdf/outline.hpp", '"prowl/motion/cost.hpp"'),
                ("prowl/nlp/nlp.hpp", '"prowl/model/robot.hpp"'),
                ("prowl/motion/cost.cpp", '"prowl/mesh/mesh.hpp"'),
                ("prowl/solvers/foreign/fatrop_solver.cpp", '"prowl/mesh/mesh.hpp"'),
                ("prowl/certificate/certificate.cpp", '"prowl/dynamics/projector.hpp"'),
                ("prowl/certificate/certificate.cpp", '"prowl/transcription/base_defects.hpp"'),
                ("prowl/transcription/base_defects.cpp", '"prowl/solvers/make_solver.hpp"'),
                ("prowl/simulation/physics.cpp", '"prowl/dynamics/projector.hpp"'),
                ("prowl/dynamics/projector.hpp", '"prowl/plan.hpp"'),
                ("prowl/task_file/task.hpp", '"prowl/plan.hpp"'),
                ("prowl/session/plan_task.cpp", '"prowl/plan_folder/plan_folder.hpp"'),
                ("prowl/plan_folder/plan_folder.cpp", '"prowl/report_page/report_file.hpp"'),
                ("prowl/plan.cpp", '"alternatives/formulation.hpp"'),
                ("prowl/plan.cpp", '"screen/summary.hpp"'),
                ("screen/summary.cpp", '"cli/screen/output.hpp"'),
                ("cli/process/interrupt.cpp", '"cli/screen/output.hpp"'),
                ("python/src/task.cpp", '"cli/screen/output.hpp"'),
                ("cli/process/process.cpp", '"cli/verbs/commands.hpp"'),
                ("prowl/tracker/tracker.cpp", '"prowl/model/so3.hpp"'),
                ("prowl/tracker/tracker.hpp", '"prowl/error.hpp"'),
            ]
        )

    def test_refuses_what_is_no_part_of_the_product(self):
        self.expect_only_the_first_to_be_refused(
            [
                ("prowl/model/robot.cpp", '"tests/support/robots.hpp"'),
                ("prowl/plan.cpp", '"bench/load.hpp"'),
                ("cli/main.cpp", '"report/page.hpp"'),
                ("python/src/task.cpp", '"python/tests/task.hpp"'),
                ("prowl/nlp/nlp.cpp", "<unheard_of/library.hpp>"),
            ]
        )

    def test_refuses_paths_that_go_up(self):
        self.expect_only_the_first_to_be_refused(
            [
                ("prowl/nlp/nlp.cpp", '"../model/robot.hpp"'),
                ("prowl/nlp/nlp.cpp", '"prowl/nlp/../model/robot.hpp"'),
                ("prowl/model/robot.cpp", '"prowl/model/../model/robot.hpp"'),
                ("prowl/motion/cost.cpp", "<Eigen/../pinocchio/algorithm/rnea.hpp>"),
            ]
        )

    def test_refuses_libraries_where_they_do_not_belong(self):
        self.expect_only_the_first_to_be_refused(
            [
                ("prowl/motion/cost.cpp", "<pinocchio/algorithm/rnea.hpp>"),
                ("prowl/transcription/base_defects.cpp", "<IpIpoptApplication.hpp>"),
                ("prowl/solvers/riccati/riccati_solver.cpp", "<IpTNLP.hpp>"),
                ("prowl/solvers/foreign/other_solver.cpp", "<IpoptConfig.h>"),
                ("prowl/nlp/nlp.cpp", "<nlohmann/json.hpp>"),
                ("prowl/nlp/nlp.cpp", "<boost/asio/post.hpp>"),
                ("prowl/model/robot.cpp", "<sys/stat.h>"),
                ("prowl/tracker/tracker.cpp", "<fmt/format.h>"),
                ("prowl/model/robot.cpp", "<toml++/toml.h>"),
                ("prowl/session/plan_task.cpp", "<CLI/CLI.hpp>"),
                ("cli/main.cpp", "<nanobind/nanobind.h>"),
            ]
        )

    def test_refuses_public_headers_that_show_a_library(self):
        self.expect_only_the_first_to_be_refused(
            [
                ("prowl/model/robot.hpp", "<pinocchio/multibody/model.hpp>"),
                ("prowl/task_file/task_file.hpp", "<toml++/toml.h>"),
                ("prowl/plan_folder/plan_json.hpp", "<nlohmann/json.hpp>"),
                ("prowl/simulation/sensors.hpp", "<boost/random/normal_distribution.hpp>"),
                ("prowl/mesh/mesh.hpp", "<fmt/format.h>"),
            ]
        )

    def test_refuses_public_headers_that_show_a_library_through_another(self):
        hidden = {
            "prowl/model/hidden.hpp": "<pinocchio/multibody/model.hpp>",
            "prowl/model/hidden.cpp": '"prowl/model/hidden.hpp"',
        }
        internal = ["prowl/model/hidden.hpp"]
        self.assertEqual([], self.found(hidden, internal))
        shows = {"prowl/dynamics/terms.hpp": '"prowl/model/hidden.hpp"'}
        self.assertEqual(1, len(self.found(hidden | shows, internal)))

    def test_refuses_an_internal_header_that_hides_nothing(self):
        self.assertEqual(1, len(self.found({"prowl/model/robot.hpp": "<Eigen/Core>"}, ["prowl/model/robot.hpp"])))

    def test_refuses_a_folder_it_does_not_know(self):
        self.assertEqual(
            1, len(self.found({"python/src/task.cpp": "<vector>", "prowl/helpers/vector.hpp": "<vector>"}))
        )

    def test_refuses_a_table_with_a_circle(self):
        self.assertEqual([], check_includes.circles())
        motion = check_includes.ALLOWED["prowl/motion"]
        motion.append("prowl/mesh")
        self.addCleanup(motion.remove, "prowl/mesh")
        self.assertTrue(check_includes.circles())

    def test_refuses_an_allowance_that_nothing_uses(self):
        self.assertEqual([], unused_allowances(ROOT))
        with unittest.mock.patch.dict(check_includes.ALLOWED, {"prowl/solvers": ["prowl/nlp", "prowl/text"]}):
            self.assertEqual(1, len(unused_allowances(ROOT)))
        with unittest.mock.patch.dict(check_includes.LIBRARIES, {"CLI11": (r"CLI/", ["cli", "screen"])}):
            self.assertEqual(1, len(unused_allowances(ROOT)))

    def test_does_not_pass_on_an_empty_tree(self):
        self.assertEqual(1, len(violations(self.root)))


if __name__ == "__main__":
    unittest.main()
