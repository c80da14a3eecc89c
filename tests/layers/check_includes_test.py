"""Puts one include at a time into a small tree and looks whether check_includes.py finds it."""

import tempfile
import unittest
from pathlib import Path

from check_includes import violations


class CheckIncludes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)

    def found(self, internal=(), **includes):
        """Violations of a tree with the given files: name with / as __, include as written after #include."""
        for name, include in includes.items():
            stem, suffix = name.rsplit("_", 1)
            path = self.root / "prowl" / f"{stem.replace('__', '/')}.{suffix}"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(f"#pragma once\n\n#include {include}\n", encoding="utf-8")
        return violations(self.root, internal)

    def test_accepts_the_direction_of_the_layers(self):
        self.assertEqual(
            [],
            self.found(
                internal=["prowl/model/pinocchio_model.hpp"],
                model__robot_hpp="<Eigen/Core>",
                model__robot_cpp='"prowl/model/pinocchio_model.hpp"',
                model__pinocchio_model_hpp="<pinocchio/multibody/model.hpp>",
                dynamics__terms_cpp="<pinocchio/algorithm/rnea.hpp>",
                motion__cost_hpp='"prowl/dynamics/terms.hpp"',
                transcription__defects_cpp='"prowl/nlp/nlp.hpp"',
                solvers__ipopt_solver_cpp="<IpTNLP.hpp>",
                nlp__nlp_cpp='"prowl/error.hpp"',
                plan_cpp='"prowl/transcription/mesh.hpp"',
            ),
        )

    def test_refuses_each_step_against_it(self):
        for name, include in [
            ("model__robot_hpp", '"prowl/motion/cost.hpp"'),
            ("nlp__nlp_hpp", '"prowl/model/robot.hpp"'),
            ("motion__cost_cpp", '"prowl/nlp/nlp.hpp"'),
            ("solvers__fatrop_solver_cpp", '"prowl/transcription/mesh.hpp"'),
            ("trajectory__certificate_cpp", '"prowl/dynamics/projector.hpp"'),
            ("transcription__defects_cpp", '"prowl/solvers/ipopt_solver.hpp"'),
            ("simulation__rollout_cpp", '"prowl/dynamics/projector.hpp"'),
            ("dynamics__projector_hpp", '"prowl/plan.hpp"'),
            ("tracker__tracker_cpp", '"prowl/model/so3.hpp"'),
            ("tracker__tracker_hpp", '"prowl/error.hpp"'),
        ]:
            with self.subTest(include=include):
                self.assertEqual(1, len(self.found(**{name: include})))
                self.assertEqual([], self.found(**{name: "<vector>"}))

    def test_refuses_libraries_where_they_do_not_belong(self):
        for name, include in [
            ("motion__cost_cpp", "<pinocchio/algorithm/rnea.hpp>"),
            ("transcription__defects_cpp", "<IpIpoptApplication.hpp>"),
            ("nlp__nlp_cpp", "<nlohmann/json.hpp>"),
            ("model__robot_cpp", "<toml++/toml.h>"),
        ]:
            with self.subTest(include=include):
                self.assertEqual(1, len(self.found(**{name: include})))
                self.assertEqual([], self.found(**{name: "<vector>"}))

    def test_refuses_public_headers_that_show_a_library(self):
        for name, include in [
            ("model__robot_hpp", "<pinocchio/multibody/model.hpp>"),
            ("solvers__ipopt_solver_hpp", "<IpTNLP.hpp>"),
            ("io__task_file_hpp", "<toml++/toml.h>"),
            ("io__plan_json_hpp", "<nlohmann/json.hpp>"),
        ]:
            with self.subTest(include=include):
                self.assertEqual(1, len(self.found(**{name: include})))
                self.assertEqual([], self.found(**{name: "<vector>"}))

    def test_refuses_public_headers_that_show_a_library_through_another(self):
        hidden = {
            "model__hidden_hpp": "<pinocchio/multibody/model.hpp>",
            "model__hidden_cpp": '"prowl/model/hidden.hpp"',
        }
        internal = ["prowl/model/hidden.hpp"]
        self.assertEqual([], self.found(internal, **hidden))
        self.assertEqual(1, len(self.found(internal, **hidden, dynamics__terms_hpp='"prowl/model/hidden.hpp"')))

    def test_refuses_an_internal_header_that_hides_nothing(self):
        self.assertEqual(1, len(self.found(["prowl/model/robot.hpp"], model__robot_hpp="<Eigen/Core>")))

    def test_refuses_a_second_file_with_ipopt(self):
        self.assertEqual(1, len(self.found(solvers__a_cpp="<IpTNLP.hpp>", solvers__b_cpp="<IpoptConfig.h>")))

    def test_refuses_a_layer_it_does_not_know(self):
        self.assertEqual(1, len(self.found(helpers__vector_hpp="<vector>")))

    def test_does_not_pass_on_an_empty_tree(self):
        self.assertEqual(1, len(violations(self.root)))


if __name__ == "__main__":
    unittest.main()
