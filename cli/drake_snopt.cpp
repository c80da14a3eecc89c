#include "drake_snopt.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "cli/process/python_script.hpp"
#include "prowl/error.hpp"
#include "prowl/nlp/constraint_violation.hpp"
#include "prowl/nlp/dual_violation.hpp"
#include "prowl/nlp/stopwatch.hpp"
#include "prowl/solvers/arguments.hpp"
#include "prowl/solvers/foreign/snopt_solver.hpp"
#include "prowl/solvers/guarded_nlp.hpp"
#include "prowl/nlp/iterate.hpp"
#include "prowl/solvers/remeasure_result.hpp"
#include "socket_process.hpp"

namespace prowl::cli {
namespace {

using Eigen::VectorXd;
using Got = SocketProcess::Got;

constexpr int kNoLibrary = 3;  ///< exit status of the script

/// Our side of the talk with solve.py, which says what goes over the wire.
class Conversation {
 public:
  Conversation(SocketProcess& process, GuardedNlp& guarded, const SolverOptions& options, double start)
      : process_(process), guarded_(guarded), nlp_(guarded.nlp()), options_(options), start_(start) {}

  bool send_program(const VectorXd& z_start) {
    const SparsityPattern& pattern = nlp_.jacobian_pattern();
    const std::array<std::int64_t, 4> sizes = {nlp_.num_variables(), nlp_.num_constraints(), pattern.size(),
                                               options_.max_iterations};
    return process_.send(sizes.data(), sizeof sizes) && send(options_.tolerance) && send(z_start) &&
           send(nlp_.variable_lower()) && send(nlp_.variable_upper()) && send(nlp_.constraint_lower()) &&
           send(nlp_.constraint_upper()) && send(pattern.rows) && send(pattern.cols);
  }

  /// Answers until the end. The result has no figures of its own yet.
  SolveResult run() {
    VectorXd z(nlp_.num_variables());
    for (;;) {
      char word = 0;
      Got got = receive(&word, 1);
      if (got == Got::all && word == 'r') return result();
      if (got == Got::all) got = receive(z.data(), bytes(z));
      if (const auto reason = why_stop(); got == Got::stopped && reason) return stopped(*reason);
      if (got != Got::all || !answer(z)) return ended();
    }
  }
  /// Of the process, if it ended before it had a result.
  std::optional<int> exit_status() const { return exit_status_; }

 private:
  static std::size_t bytes(const VectorXd& values) { return sizeof(double) * static_cast<std::size_t>(values.size()); }
  bool send(double value) { return process_.send(&value, sizeof value); }
  bool send(const VectorXd& values) { return process_.send(values.data(), bytes(values)); }
  bool send(const std::vector<int>& values) { return process_.send(values.data(), sizeof(int) * values.size()); }
  Got receive(void* data, std::size_t size) {
    return process_.receive(data, size, [this] { return why_stop().has_value(); });
  }

  std::optional<SolveStatus> why_stop() const {
    if (options_.interrupt && options_.interrupt->load()) return SolveStatus::interrupted;
    if (wall_seconds() - start_ > options_.max_seconds) return SolveStatus::time_limit;
    return std::nullopt;
  }

  /// 1 and the values, or 0 if they are not to be had.
  bool answer(const VectorXd& z) {
    double cost = 0.0;
    VectorXd gradient(z.size()), rows(nlp_.num_constraints()), jacobian(nlp_.jacobian_pattern().size());
    const bool good = guarded_.cost(z, cost) && guarded_.constraints(z, rows) && guarded_.cost_gradient(z, gradient) &&
                      guarded_.jacobian(z, jacobian);
    if (!good) return send(0.0);
    tell(z, cost, rows);
    return send(1.0) && send(cost) && send(gradient) && send(rows) && send(jacobian);
  }

  void tell(const VectorXd& z, double cost, const VectorXd& rows) {
    const IterateFigures now{cost, constraint_violation(nlp_, z, rows), 0.0};
    if (options_.on_iteration) options_.on_iteration({evaluations_, cost, now.violation, 0.0, wall_seconds() - start_});
    if (options_.on_iterate) options_.on_iterate(z);
    ++evaluations_;
    if (!is_better(now, best_, options_.tolerance)) return;
    best_ = now;
    best_z_ = z;
  }

  /// A line of JSON, z, and the multipliers if there are any.
  SolveResult result() {
    // It is there or on its way: nothing stops it now.
    const auto all = [this](void* data, std::size_t size) {
      return process_.receive(data, size, [] { return false; }) == Got::all;
    };
    std::string line;
    for (char c = 0; all(&c, 1) && c != '\n';) line += c;
    const nlohmann::json told = nlohmann::json::parse(line, nullptr, false);
    if (told.is_discarded()) return ended();
    SolveResult result;
    result.status = status_of(told.at("status"));
    result.message = told.at("message");
    result.iterations = told.at("iterations");
    result.times.cpu = told.at("cpu_seconds");
    result.z.resize(nlp_.num_variables());
    if (told.at("has_multipliers").get<bool>()) result.multipliers.resize(nlp_.num_constraints());
    if (!all(result.z.data(), bytes(result.z)) || !all(result.multipliers.data(), bytes(result.multipliers)))
      return ended();
    if (result.status == SolveStatus::evaluation_failed) result.message = guarded_.failure();
    return result;
  }

  static SolveStatus status_of(const std::string& name) {
    using enum SolveStatus;
    for (const SolveStatus status : {converged, infeasible, iteration_limit, evaluation_failed}) {
      if (name == to_string(status)) return status;
    }
    return solver_failed;
  }

  SolveResult best_so_far(SolveStatus status, std::string message) const {
    SolveResult result;
    result.status = status;
    result.message = std::move(message);
    result.z = best_z_;
    return result;
  }

  SolveResult stopped(SolveStatus why) const {
    return best_so_far(why, why == SolveStatus::interrupted ? "stopped on request" : "time limit reached");
  }

  SolveResult ended() {
    exit_status_ = process_.wait();
    return best_so_far(SolveStatus::solver_failed, fmt::format("SNOPT's process ended with status {}", *exit_status_));
  }

  SocketProcess& process_;
  GuardedNlp& guarded_;
  const Nlp& nlp_;
  const SolverOptions& options_;
  double start_;
  VectorXd best_z_;
  IterateFigures best_;
  int evaluations_ = 0;
  std::optional<int> exit_status_;
};

}  // namespace

std::optional<std::string> DrakeSnopt::why_unsupported(Nlp& nlp) const { return why_nothing_left(nlp); }

SolveResult DrakeSnopt::solve(Nlp& nlp, const VectorXd& z_start, const SolverOptions& options) const {
  check_arguments(nlp, z_start, options);
  nlp.use_threads(options.threads);
  SocketProcess process(script_command(python_, "snopt/solve.py"));
  char ready = 0;  // what it takes to start Python and to load Drake is not SNOPT's time
  const auto interrupted = [&] { return options.interrupt && options.interrupt->load(); };
  const bool is_ready = process.receive(&ready, 1, interrupted) == Got::all;

  const double start = wall_seconds(), cpu_start = cpu_seconds();
  GuardedNlp guarded(nlp);
  Conversation conversation(process, guarded, options, start);
  if (is_ready) conversation.send_program(z_start);
  SolveResult result = conversation.run();
  if (conversation.exit_status() == kNoLibrary) {
    throw InputError(
        fmt::format("{}: SNOPT comes with Drake, which is not there: PROWL_WITH_SNOPT=1 scripts/setup, or "
                    "pip install drake==1.51.1 and --python PATH; or name your own libsnopt7: --snopt-library PATH",
                    python_));
  }
  if (conversation.exit_status() && !is_ready) throw Error(result.message);
  if (result.z.size() == 0) result.z = z_start;
  if (guarded.broken()) {
    result.status = SolveStatus::solver_failed;
    result.cost = result.constraint_violation = std::numeric_limits<double>::quiet_NaN();
  } else {
    judge(nlp, options.tolerance, name(), result);
  }
  const bool has_multipliers = result.multipliers.size() == nlp.num_constraints();
  if (result.status == SolveStatus::converged && has_multipliers)
    result.dual_violation = dual_violation(nlp, result.z, result.multipliers);
  SolveTimes here = guarded.times();
  here.cpu = cpu_seconds() - cpu_start;
  result.times += here;
  result.seconds = wall_seconds() - start;
  return result;
}

std::unique_ptr<NlpSolver> make_snopt(const std::optional<std::string>& library, const std::string& python) {
  auto own = library ? std::make_unique<SnoptSolver>(*library) : std::make_unique<SnoptSolver>();
  const auto missing = own->why_unavailable();
  if (!missing) return own;
  if (library) throw InputError("--snopt-library: " + *missing);
  return std::make_unique<DrakeSnopt>(python);
}

}  // namespace prowl::cli
