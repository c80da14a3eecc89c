#include "cli/verbs/mpc_benchmark.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <mutex>
#include <nlohmann/json.hpp>

#include "cli/process/exit_status.hpp"
#include "cli/process/interrupt.hpp"
#include "cli/screen/json_result.hpp"
#include "cli/screen/output.hpp"
#include "cli/screen/progress_bar.hpp"
#include "prowl/error.hpp"
#include "prowl/files/atomic_folder.hpp"
#include "prowl/files/csv_table.hpp"
#include "prowl/files/json_parse.hpp"
#include "prowl/files/json_text.hpp"
#include "prowl/online/benchmark.hpp"
#include "prowl/online/online_json.hpp"
#include "prowl/simulation/in_parallel.hpp"
#include "screen/benchmark_table.hpp"

namespace prowl::cli {
namespace {

using Json = nlohmann::ordered_json;

/// The file of runs: an array, one object a run, as online_json() with the name of its row.
class Runs {
 public:
  Runs(const std::string& file, const RobotModel& robot) : file_(file) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return;
    runs_ = parse_json(read_text_file(file, kLongestTable));
    const auto is_run = [&](const Json& run) {
      return run.is_object() && run.value("robot", "") == robot.name() && run.contains("row") && run.contains("seed");
    };
    if (!runs_.is_array() || !std::ranges::all_of(runs_, is_run))
      throw InputError(fmt::format("{}: not a file of runs of {}; name another", file, robot.name()));
  }

  bool has(const std::string& row, std::uint64_t seed) const {
    return std::ranges::any_of(runs_, [&](const Json& run) { return run["row"] == row && run["seed"] == seed; });
  }
  void add(const std::string& row, const std::string& run) {
    Json one = {{"row", row}};
    one.update(Json::parse(run));
    runs_.push_back(std::move(one));
    write_file_atomically(file_, text());
  }
  const Json& all() const { return runs_; }
  std::string text() const { return json_text(runs_); }

 private:
  std::string file_;
  Json runs_ = Json::array();
};

std::vector<BenchmarkRow> chosen_rows(const RobotModel& robot, const OnlineOptions& base,
                                      const std::vector<std::string>& names) {
  std::vector<BenchmarkRow> rows = benchmark_rows(robot, base);
  for (const std::string& name : names) {
    if (std::ranges::none_of(rows, [&](const BenchmarkRow& row) { return row.name == name; })) {
      std::vector<std::string> all;
      for (const BenchmarkRow& row : rows) all.push_back(row.name);
      throw InputError(fmt::format("--rows: '{}' is not allowed; need some of {}", name, fmt::join(all, ", ")));
    }
  }
  if (!names.empty())
    std::erase_if(rows, [&](const BenchmarkRow& row) { return std::ranges::count(names, row.name) == 0; });
  return rows;
}

void run_row(const RobotModel& robot, const BenchmarkRow& row, const MpcBenchmark& benchmark,
             const std::atomic<bool>& interrupted, Runs& runs) {
  std::vector<std::uint64_t> seeds;
  for (int i = 0; i < row.seeds; ++i) {
    const std::uint64_t seed = benchmark.first_seed + static_cast<std::uint64_t>(i);
    if (!runs.has(row.name, seed)) seeds.push_back(seed);
  }
  if (seeds.empty() || interrupted) return;
  ProgressBar bar(fmt::format("runs of {} ({})", row.name, row.meaning), static_cast<int>(seeds.size()));
  bar.show(0);
  std::mutex lock;
  int done = 0;
  const auto work = [&](int i) {
    const OnlineOptions options = row.run(robot, seeds[static_cast<std::size_t>(i)]);
    const OnlineResult result = run_online(robot, options, [&](OnlineMoment& at) { at.stops = interrupted; });
    if (result.end == OnlineResult::End::stopped) return;
    const std::lock_guard guard(lock);
    runs.add(row.name, online_json(robot, options, result));
    bar.show(++done);
  };
  in_parallel(static_cast<int>(seeds.size()), row.is_alone ? 1 : benchmark.jobs, work, &interrupted);
  if (done < std::ssize(seeds))
    print_message(fmt::format("interrupted: {} of {} runs of {} done\n", done, seeds.size(), row.name));
}

}  // namespace

int run_mpc_benchmark(const RobotModel& robot, const OnlineOptions& base, const MpcBenchmark& benchmark, bool json) {
  const std::atomic<bool>& interrupted = catch_interrupts();
  std::vector<BenchmarkRow> rows = chosen_rows(robot, base, benchmark.rows);
  Runs runs(benchmark.file, robot);
  for (BenchmarkRow& row : rows) {
    if (benchmark.seeds > 0) row.seeds = std::min(row.seeds, benchmark.seeds);
    run_row(robot, row, benchmark, interrupted, runs);
  }
  const int status = interrupted ? kInterrupted : kPassed;
  if (json) {
    print_json({.verb = "mpc", .exit_status = status, .result = json_text({{"runs", runs.all()}})});
  } else {
    print_result(benchmark_table(robot, rows, runs.text()));
  }
  return status;
}

}  // namespace prowl::cli
