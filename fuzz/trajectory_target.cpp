// trajectory.csv of the task of sample.hpp; the same bytes as a table of numbers of any columns, as simulate.csv is.
#include "input.hpp"
#include "prowl/files/csv_table.hpp"
#include "prowl/plan_folder/trajectory_csv.hpp"
#include "prowl/task_file/reference_csv.hpp"
#include "prowl/task_file/task_file.hpp"
#include "sample.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prowl;
  static const Task task = parse_task({"task.toml", fuzz::kTask}, {"robot.toml", fuzz::kRobot}, {}, {},
                                      {.urdf = SourceText{"small.urdf", fuzz::kUrdf}});
  const SourceText source{"trajectory.csv", fuzz::text_of(data, size)};
  fuzz::takes_or_refuses([&] { trajectory_from_csv(task.problem, task.mesh, source); });
  fuzz::takes_or_refuses([&] { read_csv_table(source); });
  fuzz::takes_or_refuses([&] { read_reference_csv(task.problem.robot, source); });
  return 0;
}
