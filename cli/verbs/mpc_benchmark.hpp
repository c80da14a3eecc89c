#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "prowl/online/online_run.hpp"

namespace prowl::cli {

struct MpcBenchmark {
  std::string file;                  ///< of the runs; those in it are not run again
  std::vector<std::string> rows;     ///< names; empty: all
  int seeds = 0;                     ///< of each row, at most; 0: its own number
  std::uint64_t first_seed = 20001;  ///< far from the seeds with which weights were chosen
  int jobs = 0;                      ///< runs at a time; 0: one per core
};

/// Runs the rows of benchmark_rows() and prints their table. Returns the exit status.
int run_mpc_benchmark(const RobotModel& robot, const OnlineOptions& base, const MpcBenchmark& benchmark, bool json);

}  // namespace prowl::cli
