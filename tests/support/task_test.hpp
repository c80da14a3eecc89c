#pragma once

#include <gtest/gtest.h>

#include <string>

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/task_file/task_file.hpp"
#include "tests/support/test_files.hpp"

namespace prowl::test {

/// Tests of tasks by their text, as a user writes them: that of the task, and that of hyq.toml beside it.
class TaskTest : public testing::Test {
 protected:
  Task read(const std::string& task, const std::string& robot = kHyqFile, const TaskOverrides& overrides = {}) const {
    folder_.write("hyq.toml", robot);
    return read_task_file(folder_.write("task.toml", task), test_search(), overrides);
  }
  MotionProblem problem(const std::string& task, const std::string& robot = kHyqFile) const {
    return read(task, robot).problem;
  }
  /// On its mesh.
  DiscreteProblem prepared(const std::string& task, const std::string& robot = kHyqFile) const {
    const Task as_read = read(task, robot);
    return {as_read.problem, as_read.mesh};
  }
  std::string message_of(const std::string& task, const std::string& robot = kHyqFile) const {
    return test::message_of(folder_.path(), [&] { read(task, robot); });
  }

  TempFolder folder_;
};

/// HyQ with three knees that do not carry it.
inline const std::string kWeakHyqFile = kHyqFile + R"([limits.lf_kfe_joint]
torque_Nm = 10
[limits.rh_kfe_joint]
torque_Nm = 10
[limits.rf_kfe_joint]
torque_Nm = 10
)";

}  // namespace prowl::test
