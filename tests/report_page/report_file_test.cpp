// What is in a report, read back from the page.
#include "prowl/report_page/report_file.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "prowl/dynamics/body_bounds.hpp"
#include "prowl/files/visual_mesh.hpp"
#include "prowl/plan_folder/simulation_files.hpp"
#include "tests/support/solved_task.hpp"

namespace prowl {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string kPage = "<p>before</p><script>PROWL_REPORT_DATA</script><p>after</p>";

json data_of(const std::string& html) {
  const std::string before = "<p>before</p><script>", after = "</script><p>after</p>";
  EXPECT_THAT(html, testing::StartsWith(before));
  EXPECT_THAT(html, testing::EndsWith(after));
  return json::parse(html.substr(before.size(), html.size() - before.size() - after.size()));
}

/// HyQ's stand, planned once; a test changes a copy.
const PlanRecord& stand() {
  static const PlanRecord record = [] {
    test::SolvedTask solved = test::solve_task("hyq/stand");
    PlanRecord made{.task = std::move(solved.task), .plan = {}, .versions = {{"prowl", "1.2.3"}}};
    made.plan.mesh = made.task.mesh;
    made.plan.trajectory = std::move(solved.trajectory);
    made.plan.solver = "Riccati";
    return made;
  }();
  return record;
}

Report report_of(const PlanRecord& record, const std::string& page = kPage,
                 const PackageSearch& search = test::test_search()) {
  return make_report({.plan = record, .directory = "out/stand", .template_html = page}, search);
}

/// Numbers that are in a report as base64 of 32-bit floats.
std::vector<float> floats_of(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < text.size() && text[i] != '='; ++i) {
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(text[i]));
    if (i % 4 != 0) bytes += static_cast<char>(bits >> (6 - 2 * (i % 4)) & 0xff);
  }
  std::vector<float> numbers(bytes.size() / sizeof(float));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(float));
  return numbers;
}

const json& chart_of(const json& data, const std::string& tab, const std::string& title) {
  for (const json& all : data["charts"]) {
    if (all["name"] != tab) continue;
    for (const json& chart : all["charts"]) {
      if (chart["title"] == title) return chart;
    }
  }
  throw std::logic_error("no chart " + title);
}

/// The robot with another URDF, in `folder`.
PlanRecord with_urdf(const test::TempFolder& folder, const std::string& from, const std::string& to) {
  RobotDescription robot = stand().task.problem.robot.description();
  std::string text = robot.urdf_text;
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("no " + from);
  for (std::size_t i = at; i != std::string::npos; i = text.find(from, i + to.size())) text.replace(i, from.size(), to);
  robot.urdf = folder.write("robot.urdf", text);
  robot.urdf_text = text;
  PlanRecord record = stand();
  record.task.problem.robot = RobotModel(robot);
  return record;
}

TEST(ReportFile, HasNothingThatCouldBeMarkup) {
  PlanRecord record = stand();
  record.task.problem.name = "</script><script>alert(1)</script><!--";
  record.task.task_file.text += "# <b>\xff</b>";  // not UTF-8 either
  const Report report = report_of(record);
  const std::string data = report.html.substr(21, report.html.size() - 21 - 22);
  EXPECT_EQ(data.find('<'), std::string::npos);
  EXPECT_EQ(data_of(report.html)["plan_json"]["name"], record.task.problem.name);
}

TEST(ReportFile, NamesTheSolverOfTheCommandThatMakesThePlanAgain) {
  const auto command = [](const std::string& solver) {
    PlanRecord record = stand();
    record.plan.solver = solver;
    return data_of(report_of(record).html)["command"].get<std::string>();
  };
  EXPECT_THAT(command("Ipopt-SPRAL"), testing::HasSubstr(" --solver ipopt-spral"));
  EXPECT_THAT(command("Riccati"), testing::Not(testing::HasSubstr("--solver"))) << "the default";
  EXPECT_THAT(command("of our own"), testing::Not(testing::HasSubstr("--solver"))) << "the command has no such solver";
}

// Without it the page takes the friction of a simulation for an option of its command.
TEST(ReportFile, TellsTheFrictionThatTheTaskSimulatesWith) {
  PlanRecord record = stand();
  EXPECT_EQ(data_of(report_of(record).html)["simulated_friction"], nullptr);
  record.task.simulated_friction = 0.45;
  EXPECT_EQ(data_of(report_of(record).html)["simulated_friction"], 0.45);
}

TEST(ReportFile, HasEveryNodeOfThePlan) {
  const json data = data_of(report_of(stand()).html);
  const std::vector<double> times = data["plan"]["time"];
  for (const TrajectoryPoint& node : stand().plan.trajectory.nodes) EXPECT_THAT(times, testing::Contains(node.time));
  for (std::size_t i = 1; i < times.size(); ++i) EXPECT_LE(times[i] - times[i - 1], 0.01 + 1e-9);
  const std::size_t floats = times.size() * data["scene"]["bodies"].size() * 7;
  EXPECT_EQ(data["plan"]["placements"].get<std::string>().size(), (4 * floats + 2) / 3 * 4);
}

TEST(ReportFile, HasTheCentreOfMassAtEveryTime) {
  const json plan = data_of(report_of(stand()).html)["plan"];
  const std::vector<double> times = plan["time"];
  const std::vector<float> centres = floats_of(plan["mass_centre"]);
  ASSERT_EQ(centres.size(), 3 * times.size());
  const RobotModel& robot = stand().task.problem.robot;
  for (const TrajectoryPoint& node : stand().plan.trajectory.nodes) {
    const auto k = static_cast<std::size_t>(std::find(times.begin(), times.end(), node.time) - times.begin());
    const Eigen::Vector3d expected = centre_of_mass(robot, node.q, node.v).position;  // from the mass matrix
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(centres[3 * k + i], expected(static_cast<int>(i)), 1e-6);
  }
}

TEST(ReportFile, LimitsForcesByFrictionAndByPulling) {
  const json data = data_of(report_of(stand()).html);
  const double friction = stand().task.problem.surfaces[0].friction;
  const auto limits = [&](const std::string& title) {
    std::vector<std::vector<float>> found;
    for (const json& series : chart_of(data, "Forces", title)["series"]) {
      if (series["style"] == "limit") found.push_back(floats_of(series["values"]));
    }
    return found;
  };
  const std::vector<float> load = floats_of(chart_of(data, "Forces", "lf_foot z")["series"][0]["values"]);
  const auto along_y = limits("lf_foot y"), along_z = limits("lf_foot z");
  ASSERT_EQ(along_y.size(), 2u);
  ASSERT_EQ(along_z.size(), 1u) << "the ground may push as hard as it likes";
  for (std::size_t k = 0; k < load.size(); ++k) {
    EXPECT_GT(load[k], 10.0f);
    EXPECT_NEAR(along_y[0][k], friction * load[k], 1e-3);
    EXPECT_NEAR(along_y[1][k], -friction * load[k], 1e-3);
    EXPECT_EQ(along_z[0][k], 0.0f);
  }
}

TEST(ReportFile, LimitsTheComponentsOfAForceOnASlopeByItsCone) {
  PlanRecord record = stand();
  Surface& surface = record.task.problem.surfaces[0];
  surface.normal = Eigen::Vector3d(0.6, 0.0, 0.8);
  const json data = data_of(report_of(record).html);
  const auto series = [&](const char* axis) {
    return chart_of(data, "Forces", std::string("lf_foot ") + axis)["series"];
  };
  const std::vector<float> x = floats_of(series("x")[0]["values"]), z = floats_of(series("z")[0]["values"]);
  const std::vector<float> upper = floats_of(series("x")[1]["values"]), lower = floats_of(series("x")[2]["values"]);
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double normal = 0.6 * x[k] + 0.8 * z[k];
    EXPECT_NEAR(upper[k], normal * (0.6 + 0.8 * surface.friction), 1e-3);
    EXPECT_NEAR(lower[k], normal * (0.6 - 0.8 * surface.friction), 1e-3);
  }
}

TEST(ReportFile, HasASecondPlanToCompareWith) {
  PlanRecord second = stand();
  second.task.problem.name = "another";
  second.plan.solver = "Ipopt";
  const auto compared = [](const PlanRecord& other, const PackageSearch& search) {
    const ReportInputs first{.plan = stand(), .directory = "out/first", .template_html = kPage};
    const ReportInputs inputs{.plan = other, .directory = "out/second", .template_html = kPage};
    return make_report(first, search, &inputs);
  };
  const json data = data_of(compared(second, test::test_search()).html);
  EXPECT_EQ(data["directory"], "out/first");
  EXPECT_EQ(data["other"]["directory"], "out/second");
  EXPECT_EQ(data["other"]["plan_json"]["name"], "another");
  EXPECT_EQ(data["other"]["plan"], data["plan"]);
  EXPECT_EQ(data["other"]["charts"], data["charts"]);
  for (const char* key : {"simulation", "simulation_json"}) EXPECT_EQ(data["other"].at(key), nullptr) << key;
  EXPECT_EQ(data["other"]["scene"], nullptr) << "the same robot is there once";
  EXPECT_EQ(data_of(report_of(stand()).html)["other"], nullptr);

  const test::TempFolder folder;
  const PlanRecord bare = with_urdf(folder, "visual>", "unseen>");
  const Report report = compared(bare, test::test_search());
  EXPECT_EQ(data_of(report.html)["other"]["scene"]["visuals"].size(), 13u);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_THAT(report.warnings[0], HasSubstr("no <visual>"));
}

TEST(ReportFile, HyqsReportHasItsMeshesOnceEachAndIsSmall) {
  const Report report = report_of(stand());
  EXPECT_TRUE(report.warnings.empty());
  const json scene = data_of(report.html)["scene"];
  EXPECT_EQ(scene["meshes"].size(), 4u);
  EXPECT_LT(report.html.size(), 3u << 20);
  EXPECT_EQ(scene["visuals"].size(), 19u);
}

TEST(ReportFile, DrawsABoxForAMeshThatCannotBeReadAndSaysSo) {
  const test::TempFolder folder;
  folder.write("bad.stl", "solid nothing\nendsolid nothing\n");
  for (const char* to : {"none.dae", "bad.stl", "package://nowhere/trunk.dae", "file:///etc/passwd"}) {
    const PlanRecord record =
        with_urdf(folder, "package://example-robot-data/robots/hyq_description/meshes/trunk/trunk.dae", to);
    const Report report = report_of(record);
    ASSERT_EQ(report.warnings.size(), 1u) << to;
    EXPECT_THAT(report.warnings[0], HasSubstr("link trunk: drawn as a box of its inertia: "));
    int boxes = 0;
    const json scene = data_of(report.html)["scene"];
    for (const json& visual : scene["visuals"]) boxes += visual["link"] == "base" && visual["kind"] == "box";
    EXPECT_EQ(boxes, 1) << to;
  }
}

TEST(ReportFile, DrawsBoxesForARobotWithoutVisuals) {
  const test::TempFolder folder;
  // A <visual> is ignored where it is not in a link.
  const PlanRecord record = with_urdf(folder, "visual>", "unseen>");
  const Report report = report_of(record);
  EXPECT_EQ(data_of(report.html)["scene"]["visuals"].size(), 13u);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_THAT(report.warnings[0], HasSubstr("no <visual>"));
}

TEST(ReportFile, ShowsASimulationUpToWhereItDiverged) {
  const RobotModel& robot = stand().task.problem.robot;
  SimulationResult result;
  for (int i = 0; i < 4; ++i) {
    const Eigen::VectorXd q = robot.nominal_configuration(), v = Eigen::VectorXd::Zero(18),
                          tau = Eigen::VectorXd::Ones(12);
    SimulationSample sample;
    sample.time = 0.02 * i;
    sample.q_ref = sample.q_tracked = sample.q = sample.q_seen = q;
    sample.v_ref = sample.v = sample.v_seen = v;
    sample.feedforward = sample.feedback = sample.tau = tau;
    sample.contacts.resize(4);
    for (auto& contact : sample.contacts) contact.force.setZero();
    if (i == 3) sample.q(2) = std::nan("");
    result.samples.push_back(sample);
  }
  const std::string csv = simulation_csv(robot, result.samples);
  const auto make = [&](const std::string& text) {
    return make_report(
        {.plan = stand(), .directory = "d", .simulation = SourceText{"simulate.csv", text}, .template_html = kPage},
        test::test_search());
  };
  EXPECT_EQ(data_of(make(csv).html)["simulation"]["time"], json({0.0, 0.02, 0.04}));
  EXPECT_THAT(test::message_of("", [&] { make(test::replaced(csv, "true_q_lf_haa_joint_rad", "true_q_left_rad")); }),
              HasSubstr("simulate.csv:1: no column"));
}

TEST(ReportFile, RefusesAPageThatIsNotItsOwn) {
  for (const char* page : {"", "<html></html>", "PROWL_REPORT_DATA PROWL_REPORT_DATA"}) {
    EXPECT_THAT(test::message_of<FileError>("", [&] { report_of(stand(), page); }), HasSubstr("PROWL_REPORT_DATA"));
  }
}

}  // namespace
}  // namespace prowl
