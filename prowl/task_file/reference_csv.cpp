#include "prowl/task_file/reference_csv.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "prowl/error.hpp"
#include "prowl/files/csv_table.hpp"

namespace prowl {

namespace {

using Eigen::Index;

std::vector<std::string> posture_columns(const RobotModel& robot) {
  std::vector<std::string> names = {"base_px_m", "base_py_m", "base_pz_m", "base_qx", "base_qy", "base_qz", "base_qw"};
  for (const std::string& joint : robot.joint_names()) names.push_back(fmt::format("q_{}_rad", joint));
  return names;
}

[[noreturn]] void refuse_cell(const CsvTable& table, Index row, const std::string& column, double value,
                              const std::string& need) {
  throw InputError(fmt::format("{}:{}: {}: {:g} is not allowed; need {}", table.file, row + 2, column, value, need));
}

}  // namespace

ReferenceMotion read_reference_csv(const RobotModel& robot, const SourceText& source) {
  constexpr double kLengthError = 1e-3;  // of a quaternion: files with four decimals
  const CsvTable table = read_csv_table(source);
  if (table.rows() == 0) throw InputError(fmt::format("{}: no rows; need one or more", table.file));
  const std::vector<std::string> names = posture_columns(robot);
  const Index time = table.index("time_s");
  std::vector<Index> columns;
  for (const std::string& name : names) columns.push_back(table.index(name));
  ReferenceMotion reference{Eigen::VectorXd(table.rows()), Eigen::MatrixXd(robot.nq(), table.rows())};
  Index count = 0;
  for (Index row = 0; row < table.rows(); ++row) {
    const double now = table.values(time, row), before = row > 0 ? table.values(time, row - 1) : now;
    if (!std::isfinite(now)) refuse_cell(table, row, "time_s", now, "a finite number");
    if (now < before) refuse_cell(table, row, "time_s", now, fmt::format("{:g} or more, as in the row before", before));
    if (row > 0 && now > before) ++count;  // else this row replaces the one before
    reference.times(count) = now - table.values(time, 0);
    auto q = reference.q.col(count);
    for (Index i = 0; i < q.size(); ++i) {
      q(i) = table.values(columns[i], row);
      if (!std::isfinite(q(i))) refuse_cell(table, row, names[i], q(i), "a finite number");
    }
    auto turn = q.segment<4>(3);
    const double length = turn.norm();
    if (std::abs(length - 1.0) > kLengthError)
      refuse_cell(table, row, "length of base_qx ... base_qw", length, "a unit quaternion");
    turn /= length;
  }
  reference.times.conservativeResize(count + 1);
  reference.q.conservativeResize(Eigen::NoChange, count + 1);
  return reference;
}

}  // namespace prowl
