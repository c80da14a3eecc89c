// `prowl simulate` with both engines on a plan that holds HyQ still.
#include <gmock/gmock.h>

#include <map>
#include <sstream>

#include "command.hpp"

namespace prowl {
namespace {

using test::Outcome;
using testing::HasSubstr;
using testing::StartsWith;

using Row = std::map<std::string, double>;

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream text(line);
  for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
  return cells;
}

class Simulate : public test::Command {
 protected:
  void SetUp() override { ASSERT_EQ(run("$prowl plan hold.toml $dirs --out out").status, 0); }
  Outcome simulate(const std::string& options) const { return run("$prowl simulate out $dirs " + options); }
  nlohmann::json result() const { return nlohmann::json::parse(test::read_file(folder_.path() / "out/simulate.json")); }
  std::string series() const { return test::read_file(folder_.path() / "out/simulate.csv"); }
  std::vector<Row> rows() const {
    std::istringstream lines(series());
    std::string line;
    std::getline(lines, line);
    const std::vector<std::string> names = cells(line);
    std::vector<Row> rows;
    while (std::getline(lines, line)) {
      const std::vector<std::string> values = cells(line);
      Row& row = rows.emplace_back();
      for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = std::stod(values.at(i));
    }
    return rows;
  }
};

constexpr const char* kOffset = " --base-offset-m 0.02 -0.01 0.01 --base-offset-rad 0 0.03 0";

TEST_F(Simulate, RolloutReturnsInClosedLoopAndFallsInOpenLoop) {
  for (const char* control : {"", " --control-rate 500"}) {
    const Outcome closed = simulate(std::string("--engine rollout") + kOffset + control);
    EXPECT_EQ(closed.status, 0) << closed.error << closed.out;
    EXPECT_THAT(closed.out, HasSubstr("rollout of the projected dynamics, closed loop: success"));
    const nlohmann::json json = result();
    EXPECT_EQ(json.at("engine"), "rollout");
    EXPECT_EQ(json.at("success"), true);
    EXPECT_EQ(json.at("end"), "finished");
    EXPECT_NEAR(json.at("end_time_s").get<double>(), 3.5, 0.01) << "2 s and 1.5 s of standing";
    EXPECT_GE(json.at("base_position_m").at("largest").get<double>(), std::sqrt(6e-4) - 1e-9);
    EXPECT_GE(json.at("base_angle_rad").at("largest").get<double>(), 0.03 - 1e-9);
    EXPECT_LT(json.at("base_position_m").at("rest").get<double>(), 1e-4);
    EXPECT_LT(json.at("base_angle_rad").at("rest").get<double>(), 1e-4);
    const Row first = rows().front();
    EXPECT_NEAR(first.at("true_base_px_m") - first.at("ref_base_px_m"), 0.02, 1e-8);
    EXPECT_NEAR(first.at("true_base_py_m") - first.at("ref_base_py_m"), -0.01, 1e-8);
    EXPECT_NEAR(first.at("true_base_qy") - first.at("ref_base_qy"), std::sin(0.015), 1e-8) << "pitch";
  }
  const Outcome open = simulate(std::string("--engine rollout --open-loop") + kOffset);
  EXPECT_EQ(open.status, 8) << open.error << open.out;
  EXPECT_THAT(open.out, HasSubstr("failed: fell at "));
  EXPECT_EQ(result().at("end"), "fell");
  EXPECT_LT(result().at("end_time_s"), 3.0);
  EXPECT_TRUE(result().at("base_position_m").at("rest").is_null()) << "it never rested";
  EXPECT_THAT(open.out, ::testing::Not(HasSubstr("nan")));
  for (const Row& row : rows()) EXPECT_EQ(row.at("feedback_lf_kfe_joint_Nm"), 0.0);
}

TEST_F(Simulate, RolloutIsTheSameBitForBit) {
  const Outcome one = simulate(std::string("--engine rollout --json") + kOffset);
  const std::string series_of_one = series();
  const Outcome two = simulate(std::string("--engine rollout --json") + kOffset);
  EXPECT_EQ(one.out, two.out);
  EXPECT_EQ(series_of_one, series());
  EXPECT_GT(rows().size(), 600u);
  EXPECT_NE(simulate(std::string("--engine rollout --json --control-rate 100") + kOffset).out, one.out);
}

/// Two models of contact, two integrators; the robot's weight and how its torques spread it over the feet are the same.
TEST_F(Simulate, EnginesAgreeOnTheForcesOfStanding) {
  ASSERT_EQ(simulate("--perfect-state").status, 0);
  EXPECT_EQ(result().at("engine"), "mujoco");
  const Row mujoco = rows().back();
  ASSERT_EQ(simulate("--engine rollout").status, 0);
  const Row rollout = rows().back();
  ASSERT_EQ(mujoco.size(), rollout.size());
  double weight = 0.0;
  for (const char* foot : {"lf_foot", "rf_foot", "lh_foot", "rh_foot"}) {
    double difference = 0.0, size = 0.0;
    for (const char axis : {'x', 'y', 'z'}) {
      const std::string column = std::string("f_") + foot + "_" + axis + "_N";
      difference += std::pow(mujoco.at(column) - rollout.at(column), 2);
      size += std::pow(rollout.at(column), 2);
    }
    EXPECT_LT(std::sqrt(difference), 0.02 * std::sqrt(size)) << foot;
    weight += rollout.at(std::string("f_") + foot + "_z_N");
    EXPECT_EQ(rollout.at(std::string("touch_") + foot), 1.0);
  }
  EXPECT_GT(weight, 500.0) << "nothing stands";
}

TEST_F(Simulate, RolloutTellsThatItsContactsPull) {
  const Outcome tilted = simulate("--engine rollout --base-offset-m 0.05 0 0 --base-offset-rad 0 0.1 0");
  ASSERT_EQ(tilted.status, 0) << tilted.error;
  EXPECT_THAT(tilted.out, HasSubstr("would lift"));
  double least = 1e9;
  const nlohmann::json contacts = result().at("contacts");
  for (const auto& [foot, load] : contacts.items()) {
    const double normal = load.at("least_normal_force_N");
    least = std::min(least, normal);
    double least_row = 1e9;
    for (const Row& row : rows()) least_row = std::min(least_row, row.at("f_" + foot + "_z_N"));
    EXPECT_LE(normal, least_row + 1e-6) << foot << ": the series has a row in five";
    EXPECT_GT(normal, least_row - 50.0) << foot;
  }
  EXPECT_LT(least, 0.0);
  EXPECT_THAT(result().at("contact_model").get<std::string>(), HasSubstr("pull"));
}

TEST_F(Simulate, RefusesOptionsOfTheOtherEngine) {
  ASSERT_EQ(simulate("--json").status, 0);
  const std::string before = series();
  for (const char* option : {"--noise 0", "--delay 2", "--push 0.5 0 10 0", "--push-duration 0.2", "--friction 0.5",
                             "--mass 1", "--bandwidth 10", "--step 0.001", "--case 3", "--perfect-state", "--seed 1"}) {
    const Outcome refused = simulate(std::string("--engine rollout ") + option);
    EXPECT_EQ(refused.status, 2) << option;
    EXPECT_THAT(refused.error,
                StartsWith("prowl: " + std::string(option).substr(0, std::string(option).find(' ')) + ": not with"));
  }
  for (const char* option : {"--base-offset-m 0 0 0.01", "--base-offset-rad 0 0 0.01"}) {
    EXPECT_EQ(simulate(option).status, 2) << option;
    EXPECT_THAT(simulate(option).error, HasSubstr("use --engine rollout"));
  }
  for (const char* option : {"--control-rate 1", "--control-rate nan", "--base-offset-m 0 0 1",
                             "--base-offset-m nan 0 0", "--base-offset-rad 0 0"}) {
    EXPECT_EQ(simulate(std::string("--engine rollout ") + option).status, 2) << option;
  }
  EXPECT_EQ(simulate("--engine bullet").status, 2);
  EXPECT_EQ(series(), before) << "nothing is written on bad input";
}

}  // namespace
}  // namespace prowl
