#include "prowl/plan_folder/plan_folder.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/plan_folder/trajectory_csv.hpp"
#include "prowl/task_file/task_file.hpp"
#include "tests/support/reference_csv.hpp"
#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

using testing::HasSubstr;

/// Two phases of HyQ with numbers that no decimal fraction of few digits can hold.
PlanRecord make_record(const std::filesystem::path& folder) {
  const std::string second =
      "[[phase]]\nname = \"flight\"\ncontacts = [\"lf_foot\"]\nduration_s = 0.3\nintervals = 3\n[start]";
  const Task task = parse_task({folder / "task.toml", test::replaced(test::kTaskFile, "[start]", second)},
                               {folder / "hyq.toml", test::kHyqFile}, test::test_search());
  std::srand(7);  // Eigen's random vectors
  Plan plan;
  plan.mesh = task.mesh;
  double begin = 0.0;
  for (int p = 0; p < 2; ++p) {
    const Phase& phase = task.problem.phases[p];
    for (int i = 0; i <= task.mesh.phases[p].intervals(); ++i) {
      TrajectoryPoint point{.time = begin + phase.duration.min * i / task.mesh.phases[p].intervals(),
                            .phase = p,
                            .q = task.problem.start_configuration(),
                            .v = Eigen::VectorXd::Random(18),
                            .a = 1e3 * Eigen::VectorXd::Random(18),
                            .tau = 1e-12 * Eigen::VectorXd::Random(12),
                            .force = 1e6 * Eigen::VectorXd::Random(12)};
      point.q.tail(12).setRandom();
      plan.trajectory.nodes.push_back(point);
    }
    begin += phase.duration.min;
  }
  plan.result.status = SolveStatus::interrupted;
  plan.result.message = "stopped \"by hand\"";
  plan.result.iterations = 12;
  plan.result.pivoted_stages = 2;
  plan.result.cost = 1.0 / 3.0;
  plan.certificate.grade = CertificateGrade::draft;
  plan.certificate.passed = true;
  plan.certificate.checks.push_back({"contact drift", 1.0 / 7.0, 1e-3, "m", 0.1, "lf_foot", false});
  plan.certificate.checks.push_back({"torque", std::nan(""), 1.0, "-", 0.2, "", false});
  plan.certificate.interval_errors.push_back({0.0, 0.4, 1e-5, "v lf_haa_joint"});
  plan.certificate.redundant_contacts = {"lf_foot", "rh_foot"};
  plan.certificate.contact_ranks = {{"stand", 12, 11}};
  plan.reasons = {"too far"};
  plan.hints = {"too \"heavy\"", "too weak"};
  plan.num_variables = 99;
  return {.task = task, .plan = plan, .versions = {{"prowl", "1.2.3"}}};
}

/// `csv` with another value in one cell; line 1 is the heading, columns count from 0.
std::string with_cell(const std::string& csv, int line, int column, const std::string& value) {
  std::size_t at = 0;
  for (int i = 1; i < line; ++i) at = csv.find('\n', at) + 1;
  for (int i = 0; i < column; ++i) at = csv.find(',', at) + 1;
  return csv.substr(0, at) + value + csv.substr(csv.find_first_of(",\n", at));
}

class PlanDirectory : public testing::Test {
 protected:
  std::string message() {
    return test::message_of(folder_.path(), [&] { read_plan(out_, test::test_search()); });
  }
  void edit(const std::string& file, const std::string& from, const std::string& to) {
    const std::string text = test::read_file(out_ / file);
    folder_.write("out/" + file, test::replaced(text, from, to));
  }
  test::TempFolder folder_;
  const std::filesystem::path out_ = folder_.path() / "out";
  const PlanRecord record_ = make_record(folder_.path());
};

TEST_F(PlanDirectory, ReadsBackWhatItWrote) {
  write_plan(out_, record_);
  const PlanRecord read = read_plan(out_, test::test_search());
  ASSERT_EQ(read.plan.trajectory.nodes.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) {
    const TrajectoryPoint& a = record_.plan.trajectory.nodes[i];
    const TrajectoryPoint& b = read.plan.trajectory.nodes[i];
    EXPECT_EQ(a.time, b.time);
    EXPECT_EQ(a.phase, b.phase);
    EXPECT_EQ(a.q, b.q) << "to the last bit";
    EXPECT_EQ(a.v, b.v);
    EXPECT_EQ(a.a, b.a);
    EXPECT_EQ(a.tau, b.tau);
    EXPECT_EQ(a.force, b.force);
  }
  EXPECT_EQ(read.plan.result.status, SolveStatus::interrupted);
  EXPECT_EQ(read.plan.result.message, record_.plan.result.message);
  EXPECT_EQ(read.plan.result.pivoted_stages, 2);
  EXPECT_EQ(read.plan.result.cost, 1.0 / 3.0);
  EXPECT_EQ(read.plan.certificate.grade, CertificateGrade::draft);
  ASSERT_EQ(read.plan.certificate.checks.size(), 2u);
  EXPECT_EQ(read.plan.certificate.checks[0].worst, 1.0 / 7.0);
  EXPECT_TRUE(std::isnan(read.plan.certificate.checks[1].worst));
  EXPECT_EQ(read.plan.certificate.redundant_contacts, (std::vector<std::string>{"lf_foot", "rh_foot"}));
  ASSERT_EQ(read.plan.certificate.contact_ranks.size(), 1u);
  EXPECT_EQ(read.plan.certificate.contact_ranks[0].phase, "stand");
  EXPECT_EQ(read.plan.certificate.contact_ranks[0].rows, 12);
  EXPECT_EQ(read.plan.certificate.contact_ranks[0].rank, 11);
  EXPECT_EQ(read.plan.reasons, record_.plan.reasons);
  EXPECT_EQ(read.plan.hints, record_.plan.hints);
  EXPECT_EQ(read.plan.certificate.interval_errors.at(0).where, "v lf_haa_joint");
  EXPECT_EQ(read.plan.num_variables, 99);
  EXPECT_EQ(read.versions, record_.versions);
  EXPECT_EQ(read.task.problem.phases.size(), 2u);
  EXPECT_EQ(read.task.task_file.text, record_.task.task_file.text);
}

TEST_F(PlanDirectory, ReadsPhasesOfFreeDurationAsLongAsTheyMayBe) {
  PlanRecord record = record_;
  std::string free = test::replaced(record.task.task_file.text, "duration_s = 0.3", "duration_s = [0.2, 0.4]");
  free = test::replaced(free, "time_s = 2.0", "phase = \"stand\"");
  record.task = parse_task({folder_.path() / "task.toml", free}, record.task.robot_file, test::test_search());
  write_plan(out_, record);
  EXPECT_NEAR(read_plan(out_, test::test_search()).plan.trajectory.duration(), 2.3, 1e-12);
  const auto json = nlohmann::json::parse(test::read_file(out_ / "plan.json"));
  EXPECT_NEAR(json.at("problem").at("phases").at(1).at("duration_s"), 0.3, 1e-12) << "as planned";

  for (int i = 6; i < 10; ++i) record.plan.trajectory.nodes[i].time += 0.2 * (i - 6) / 3.0;
  write_plan(out_, record);
  EXPECT_THAT(message(), HasSubstr("trajectory.csv:11: phase 'flight' lasts 0.5"));
}

TEST_F(PlanDirectory, SaysWhetherItIsFinished) {
  write_plan(out_, record_);
  const auto json = nlohmann::json::parse(test::read_file(out_ / "plan.json"));
  EXPECT_EQ(json.at("schema_version"), 10);
  EXPECT_EQ(json.at("status"), "interrupted");
  EXPECT_EQ(json.at("finished"), false);
  EXPECT_EQ(json.at("certificate").at("passed"), true);
  EXPECT_EQ(json.at("certificate").at("grade"), "draft");
}

TEST_F(PlanDirectory, ColumnsAreThoseOfTheDocumentation) {
  const std::vector<std::string> columns = trajectory_columns(record_.task.problem.robot);
  ASSERT_EQ(columns.size(), 2u + 7 + 6 + 6 + 4 * 12 + 4 * 4);
  EXPECT_EQ(columns[8], "base_qw");
  EXPECT_EQ(columns[14], "base_wz_radps");
  EXPECT_EQ(columns[20], "base_dwz_radps2");
  EXPECT_EQ(columns[21], "q_lf_haa_joint_rad");
  EXPECT_EQ(columns[21 + 12], "v_lf_haa_joint_radps");
  EXPECT_EQ(columns[21 + 24], "a_lf_haa_joint_radps2");
  EXPECT_EQ(columns[21 + 36], "tau_lf_haa_joint_Nm");
  EXPECT_EQ(columns[21 + 48], "contact_lf_foot");
  EXPECT_EQ(columns[21 + 51], "f_lf_foot_z_N");
}

TEST_F(PlanDirectory, ContactFlagsAreThoseOfThePhase) {
  const std::string csv = trajectory_to_csv(record_.task.problem, record_.plan.trajectory);
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  for (int row = 0; std::getline(lines, line); ++row) {
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    ASSERT_EQ(cells.size(), 85u);
    const bool second_phase = row >= 6;
    EXPECT_EQ(cells[1], second_phase ? "1" : "0");
    EXPECT_EQ(cells[69], "1") << "lf_foot holds in both phases";
    EXPECT_EQ(cells[73], second_phase ? "0" : "1") << "rf_foot only in the first";
  }
}

TEST_F(PlanDirectory, SamplesAUniformGrid) {
  write_plan(out_, record_, 0.25);
  const Trajectory samples = sample_uniformly(record_.plan.trajectory, 0.25);
  ASSERT_EQ(samples.nodes.size(), 11u) << "0, 0.25 ... 2.25 and the end at 2.3";
  EXPECT_EQ(samples.nodes[1].time, 0.25);
  EXPECT_EQ(samples.nodes[9].phase, 1);
  EXPECT_DOUBLE_EQ(samples.nodes[10].time, 2.3);
  EXPECT_EQ(test::read_file(out_ / "trajectory_uniform.csv"), trajectory_to_csv(record_.task.problem, samples));
  write_plan(out_, record_);
  EXPECT_FALSE(std::filesystem::exists(out_ / "trajectory_uniform.csv")) << "of the plan before";
}

TEST_F(PlanDirectory, RefusesWhatIsNoPlan) {
  EXPECT_EQ(message(), "out/plan.json: no such file");
  write_plan(out_, record_);
  edit("plan.json", "\"schema_version\": 10", "\"schema_version\": 4294967297");
  EXPECT_THAT(message(), HasSubstr("plan.schema_version: 4294967297 is not allowed; need an integer from "))
      << "1 modulo 2^32";
  write_plan(out_, record_);
  edit("plan.json", "\"status\": \"interrupted\"", "\"status\": \"fine\"");
  EXPECT_THAT(message(), HasSubstr("plan.status: \"fine\" is not allowed; need one of converged, "));
  write_plan(out_, record_);
  edit("plan.json", "\"iterations\": 12", "\"iterations\": \"12\"");
  EXPECT_EQ(
      message(),
      "out/plan.json: plan.solver.iterations: \"12\" is not allowed; need an integer from -2147483647 to 2147483647");
  write_plan(out_, record_);
  edit("plan.json", "\"passed\": true,", "");
  EXPECT_EQ(message(), "out/plan.json: plan.certificate.passed: missing");
  write_plan(out_, record_);
  folder_.write("out/plan.json", "{\n  torn");
  EXPECT_EQ(message(), "out/plan.json:2:4: not JSON from here on: the file is cut short or was edited");
  EXPECT_EQ(test::message_of(folder_.path(), [&] { read_plan(out_ / "plan.json", test::test_search()); }),
            "out/plan.json: this is a file; need the folder that prowl plan wrote");
}

TEST_F(PlanDirectory, ReadsOlderVersionsAndTellsWhatToDoWithOthers) {
  const auto write_version = [&](int version, const auto& change) {
    write_plan(out_, record_);
    auto json = nlohmann::ordered_json::parse(test::read_file(out_ / "plan.json"));
    json["schema_version"] = version;
    change(json);
    folder_.write("out/plan.json", json.dump());
  };
  const auto remove_robustness = [](auto& json) { ASSERT_EQ(json.erase("robustness"), 1u); };
  const auto remove_guess = [&](auto& json) {
    remove_robustness(json);
    ASSERT_EQ(json["solver"]["evaluation"].erase("guess"), 1u);
  };
  const auto remove_interpolation = [&](auto& json) {
    remove_guess(json);
    ASSERT_EQ(json["problem"].erase("interpolation"), 1u);
  };
  const auto remove_pivoted_stages = [&](auto& json) {
    remove_interpolation(json);
    ASSERT_EQ(json["solver"].erase("pivoted_stages"), 1u);
  };
  const auto remove_shares = [&](auto& json) {
    remove_pivoted_stages(json);
    for (auto& phase : json["problem"]["phases"]) ASSERT_EQ(phase.erase("shares"), 1u);
    for (auto& interval : json["certificate"]["integration_errors"]) ASSERT_EQ(interval.erase("reintegration"), 1u);
  };
  const auto remove_new_keys = [&](auto& json) {
    remove_shares(json);
    for (const char* key : {"hessian", "cpu_seconds", "evaluation", "convergence"})
      ASSERT_EQ(json["solver"].erase(key), 1u) << key;
  };
  write_version(1, remove_new_keys);
  const PlanRecord old = read_plan(out_, test::test_search());
  EXPECT_EQ(old.plan.result.cost, 1.0 / 3.0);
  EXPECT_EQ(old.plan.hessian, HessianKind::exact);
  EXPECT_EQ(old.plan.trajectory.nodes.size(), record_.plan.trajectory.nodes.size());
  write_version(2, remove_new_keys);
  EXPECT_EQ(message(), "out/plan.json: plan.solver.cpu_seconds: missing");
  write_version(2, remove_shares);
  EXPECT_TRUE(std::isnan(read_plan(out_, test::test_search()).plan.certificate.interval_errors.at(0).reintegration));
  write_version(3, remove_shares);
  EXPECT_EQ(message(), "out/plan.json: plan.problem.phases[0].shares: missing");
  write_version(3, remove_pivoted_stages);
  EXPECT_EQ(read_plan(out_, test::test_search()).plan.result.pivoted_stages, 0);
  write_version(4, remove_pivoted_stages);
  EXPECT_EQ(message(), "out/plan.json: plan.solver.pivoted_stages: missing");
  write_version(4, remove_interpolation);
  EXPECT_EQ(read_plan(out_, test::test_search()).plan.trajectory.interpolation, Interpolation::trapezoid);
  write_version(5, remove_interpolation);
  EXPECT_EQ(message(), "out/plan.json: plan.problem.interpolation: missing");
  write_version(5, remove_guess);
  EXPECT_EQ(read_plan(out_, test::test_search()).plan.result.times.guess, 0.0);
  write_version(6, remove_guess);
  EXPECT_EQ(message(), "out/plan.json: plan.solver.evaluation.guess: missing");
  write_version(6, remove_robustness);
  EXPECT_FALSE(read_plan(out_, test::test_search()).robustness.has_value());
  write_version(7, remove_robustness);
  EXPECT_EQ(message(), "out/plan.json: plan.robustness: missing");
  const auto remove_sizes_since = [](int version) {
    return [version](auto& json) {
      auto& robustness = json["robustness"] = {{"share", 0.5}, {"solves", 1}, {"tightest", ""}};
      for (const DisturbanceKey& key : kDisturbanceKeys)
        if (key.since < version) robustness["sizes"][key.name] = 0.1;
    };
  };
  write_version(7, remove_sizes_since(8));
  EXPECT_EQ(read_plan(out_, test::test_search()).robustness->sizes.ground, 0.0);
  write_version(8, remove_sizes_since(8));
  EXPECT_EQ(message(), "out/plan.json: plan.robustness.sizes.ground_m: missing");
  write_version(8, remove_sizes_since(9));
  EXPECT_EQ(read_plan(out_, test::test_search()).robustness->sizes.ground, 0.1);
  EXPECT_EQ(read_plan(out_, test::test_search()).robustness->sizes.estimate_angle, 0.0);
  write_version(9, remove_sizes_since(9));
  EXPECT_EQ(message(), "out/plan.json: plan.robustness.sizes.estimate_position_m: missing");
  const auto remove_reference = [](auto& json) { ASSERT_EQ(json.erase("reference_file"), 1u); };
  write_version(9, remove_reference);
  EXPECT_FALSE(read_plan(out_, test::test_search()).task.reference_file.has_value());
  write_version(10, remove_reference);
  EXPECT_EQ(message(), "out/plan.json: plan.reference_file: missing");
  write_version(5, [](auto& json) { json["problem"]["interpolation"] = "linear"; });
  EXPECT_EQ(message(),
            "out/plan.json: plan.problem.interpolation: \"linear\" is not allowed; need trapezoid or hermite");
  write_version(11, [](auto&) {});
  EXPECT_EQ(
      message(),
      "out/plan.json: plan.schema_version: 11, written by a newer Prowl; this one reads 1 to 10: use that Prowl, or "
      "plan again with this one");
  write_version(0, [](auto&) {});
  EXPECT_EQ(
      message(),
      "out/plan.json: plan.schema_version: 0 is no longer supported; need 1 to 10: plan again with prowl plan; its "
      "task_file contains the task");
  write_version(5, [](auto& json) { json.erase("schema_version"); });
  EXPECT_EQ(message(), "out/plan.json: plan.schema_version: missing");
}

/// Another mesh than the task has: steps that differ, goals at other nodes of it.
TEST_F(PlanDirectory, ReadsTheMeshThatAPlanWasRefinedTo) {
  PlanRecord record = record_;
  record.plan.mesh = {{PhaseMesh({1.0, 2.0, 4.0}), PhaseMesh(2)}};
  record.plan.trajectory = {};
  const DiscreteProblem discrete(record.task.problem, record.plan.mesh);
  for (const MeshNode& node : discrete.nodes) {
    record.plan.trajectory.nodes.push_back(record_.plan.trajectory.nodes[node.phase == 0 ? 0u : 6u]);
    record.plan.trajectory.nodes.back().time = node.time;
  }
  write_plan(out_, record);
  const PlanRecord read = read_plan(out_, test::test_search());
  ASSERT_EQ(read.plan.trajectory.nodes.size(), 4u + 3u);
  for (std::size_t i = 0; i < 7; ++i)
    EXPECT_EQ(read.plan.trajectory.nodes[i].time, record.plan.trajectory.nodes[i].time);
  EXPECT_NEAR(read.plan.trajectory.nodes[1].time, 2.0 / 7.0, 1e-12);
  EXPECT_EQ(read.plan.mesh.phases[0].intervals(), 3);
  EXPECT_THAT(read.plan.mesh.phases[0].shares(),
              testing::Pointwise(testing::DoubleNear(1e-15), {1 / 7.0, 2 / 7.0, 4 / 7.0}));
  EXPECT_EQ(read.plan.mesh.phases[1].intervals(), 2);
  EXPECT_TRUE(read.plan.mesh.phases[1].is_even());
  EXPECT_EQ(read.task.mesh.phases[0].intervals(), 5) << "that of the task stays";
  for (std::size_t i = 0; i < read.task.problem.boundary_constraints.size(); ++i) {
    EXPECT_EQ(read.task.problem.boundary_constraints[i].at, record.task.problem.boundary_constraints[i].at);
  }

  const std::string csv = test::read_file(out_ / "trajectory.csv");
  folder_.write("out/trajectory.csv", with_cell(csv, 3, 0, "0.4"));  // where equal steps of five would have it
  EXPECT_THAT(message(), HasSubstr("out/trajectory.csv:3: time_s: 0.4 is not allowed; need 0.28571"));
}

TEST_F(PlanDirectory, RefusesAMeshThatIsNone) {
  const auto message_with = [&](const auto& change) {
    write_plan(out_, record_);
    auto json = nlohmann::ordered_json::parse(test::read_file(out_ / "plan.json"));
    change(json["problem"]["phases"]);
    folder_.write("out/plan.json", json.dump());
    return message();
  };
  EXPECT_EQ(
      message_with([](auto& phases) { phases[1]["shares"] = {0.5, 0.5}; }),
      "out/plan.json: plan.problem.phases[1].shares: 2 numbers with sum 1; need 3 numbers > 0 with sum 1, or none");
  EXPECT_THAT(message_with([](auto& phases) { phases[1]["shares"] = {0.5, nullptr, 0.5}; }),
              HasSubstr("need 3 numbers > 0 with sum 1, or none"));
  EXPECT_THAT(message_with([](auto& phases) { phases[1]["shares"] = {0.5, 0.7, -0.2}; }),
              HasSubstr("need 3 numbers > 0 with sum 1, or none"));
  EXPECT_THAT(message_with([](auto& phases) { phases[1]["shares"] = {0.5, 1.0, 0.5}; }),
              HasSubstr("3 numbers with sum 2; need"));
  EXPECT_EQ(message_with([](auto& phases) { phases[0]["intervals"] = 0; }),
            "out/plan.json: plan.problem.phases[0].intervals: 0 is not allowed; need 1 to 10000");
  EXPECT_EQ(message_with([](auto& phases) { phases[1]["intervals"] = 9996; }),
            "out/plan.json: plan.problem.phases[1].intervals: 9996 is not allowed; need 1 to 9995")
      << "10,000 in all";
  EXPECT_EQ(message_with([](auto& phases) { phases.erase(1); }),
            "out/plan.json: plan.problem.phases: 1 phases; the task has 2");
  EXPECT_EQ(message_with([](auto& phases) { phases[0]["intervals"] = 7; }),
            "out/trajectory.csv: 10 rows; the task's mesh has 12 nodes");
}

TEST_F(PlanDirectory, IsGoodIfTheSolverConvergedAndTheCertificatePassed) {
  PlanRecord record = record_;
  for (const bool converged : {false, true}) {
    for (const bool passed : {false, true}) {
      record.plan.result.status = converged ? SolveStatus::converged : SolveStatus::time_limit;
      record.plan.certificate.passed = passed;
      write_plan(out_, record);
      EXPECT_EQ(nlohmann::json::parse(test::read_file(out_ / "plan.json")).at("good"), converged && passed);
      EXPECT_EQ(holds_good_plan(out_), converged && passed);
    }
  }
  folder_.write("out/plan.json", "{ torn");
  EXPECT_FALSE(holds_good_plan(out_));
  EXPECT_FALSE(holds_good_plan(folder_.path() / "none"));
}

// HyQ with its URDF beside it, which then is lost or edited.
TEST_F(PlanDirectory, KeepsTheUrdf) {
  const std::filesystem::path source = record_.task.problem.robot.description().urdf;
  const auto urdf = folder_.write("hyq.urdf", test::read_file(source) + "<!-- caf\xe9 -->");  // Latin-1, not UTF-8
  PlanRecord record = record_;
  const std::string path = "package://example-robot-data/robots/hyq_description/robots/hyq_no_sensors.urdf";
  record.task = parse_task(record_.task.task_file,
                           {folder_.path() / "hyq.toml", test::replaced(test::kHyqFile, path, "hyq.urdf")}, {});
  write_plan(out_, record);
  EXPECT_EQ(read_plan(out_, {}).task.problem.robot.name(), "HyQ");
  folder_.write("hyq.urdf", test::read_file(urdf) + " ");
  EXPECT_EQ(message(),
            "out/plan.json: hyq.urdf has changed since the plan was made; need the old URDF, or no file "
            "there: Prowl then uses the copy in plan.json");
  std::filesystem::remove(urdf);
  EXPECT_EQ(read_plan(out_, {}).task.problem.robot.mass(), record_.task.problem.robot.mass());
}

TEST_F(PlanDirectory, KeepsTheReference) {
  const auto csv = folder_.write("motion.csv", test::reference_csv({0.0, 1.0}));
  PlanRecord record = record_;
  const SourceText& text = record_.task.task_file;
  record.task = parse_task(
      {folder_.path() / "task.toml", text.text + "\n[reference]\nfile = \"motion.csv\"\njoint_position = 1\n"},
      record_.task.robot_file, test::test_search());
  write_plan(out_, record);
  std::filesystem::remove(csv);
  const Task read = read_plan(out_, test::test_search()).task;
  EXPECT_EQ(read.reference_file->text, test::reference_csv({0.0, 1.0}));
  EXPECT_EQ(read.problem.reference->q, record.task.problem.reference->q);
}

TEST_F(PlanDirectory, WritesPathsThatAreNotUtf8) {
  PlanRecord record = record_;
  record.task.task_file.path = folder_.path() / "caf\xe9.toml";
  write_plan(out_, record);
  const auto json = nlohmann::json::parse(test::read_file(out_ / "plan.json"));
  EXPECT_THAT(json.at("task_file").at("path").get<std::string>(), testing::EndsWith("caf\xef\xbf\xbd.toml"));
  EXPECT_NO_THROW(nlohmann::json::parse(plan_report_json(record, folder_.path() / "\xff")));
}

TEST_F(PlanDirectory, RefusesATrajectoryThatDoesNotFit) {
  const std::string csv = trajectory_to_csv(record_.task.problem, record_.plan.trajectory);
  const auto message_with = [&](const std::string& text) {
    write_plan(out_, record_);
    folder_.write("out/trajectory.csv", text);
    return message();
  };
  EXPECT_THAT(message_with(test::replaced(csv, "\n0.4,0,", "\nnan,0,")),
              testing::Eq("out/trajectory.csv:3: time_s: \"nan\" is not allowed; need a finite number"));
  EXPECT_THAT(message_with(test::replaced(csv, "\n0.4,0,", "\n0.5,0,")),
              HasSubstr("trajectory.csv:3: time_s: 0.5 is not allowed; need 0.4"));
  EXPECT_THAT(message_with(test::replaced(csv, "\n0.4,0,", "\n0.4,0.5,")),
              HasSubstr("trajectory.csv:3: phase: 0.5 is not"));
  EXPECT_THAT(message_with(test::replaced(csv, "\n0.4,0,", "\n0.4,1e300,")),
              HasSubstr("trajectory.csv:3: phase: 1e+300 is"));
  EXPECT_EQ(message_with(csv.substr(0, csv.size() - 1)),
            "out/trajectory.csv: the last line has no line end; the file is cut short");
  EXPECT_EQ(message_with(with_cell(csv, 9, 73, "1")),
            "out/trajectory.csv:9: contact_rf_foot: 1 is not allowed; need 0, as in the task");
  EXPECT_EQ(message_with(with_cell(csv, 9, 69, "0.5")),
            "out/trajectory.csv:9: contact_lf_foot: 0.5 is not allowed; need 1, as in the task");
  EXPECT_THAT(message_with(with_cell(csv, 9, 8, "2")), HasSubstr("trajectory.csv:9: norm of base_qx ... base_qw: "));
  EXPECT_THAT(message_with(test::replaced(csv, "\n0.4,0,", "\n0.4,")),
              HasSubstr("trajectory.csv:3: 84 cells; need 85"));
  EXPECT_THAT(message_with(test::replaced(csv, "base_px_m", "base_x_m")),
              HasSubstr("the columns are not those of HyQ"));
  EXPECT_THAT(message_with(csv.substr(0, csv.rfind('\n', csv.size() - 2) + 1)),
              HasSubstr("9 rows; the task's mesh has 10"));
  EXPECT_THAT(message_with(""), HasSubstr("the columns are not those of HyQ"));
}

TEST_F(PlanDirectory, ReportLeavesTheTextsOut) {
  const auto json = nlohmann::json::parse(plan_report_json(record_, out_));
  EXPECT_FALSE(json.at("task_file").contains("text"));
  EXPECT_EQ(json.at("directory"), out_.string());
}

}  // namespace
}  // namespace prowl
