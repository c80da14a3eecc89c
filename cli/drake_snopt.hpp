#pragma once

#include <memory>
#include <optional>
#include <string>

#include "prowl/nlp/nlp_solver.hpp"

namespace prowl::cli {

/// The SNOPT in Drake's Python wheel, which runs in a process of its own (share/prowl/snopt/solve.py) and asks this one
/// for values and derivatives of the program. See SnoptSolver for what SNOPT is.
///
/// - on_iteration is told of evaluations; SNOPT's major iterations are known at the end.
/// - An evaluation that fails ends the solve: Drake has no way to tell SNOPT to take a shorter step.
/// - Interrupts and time are looked at ten times a second, and end the process; what comes back then is the point of
/// least
///   violation that was evaluated, without a number of iterations and the CPU time of that process.
class DrakeSnopt : public NlpSolver {
 public:
  /// A Python with numpy and pydrake.
  explicit DrakeSnopt(std::string python) : python_(std::move(python)) {}

  std::string name() const override { return "SNOPT"; }
  std::string version() const override { return "7.4, of Drake"; }
  std::optional<std::string> why_unsupported(Nlp& nlp) const override;
  /// Throws InputError if an option or the size of z_start makes no sense, or if Python or Drake is missing; Error if
  /// the process fails.
  SolveResult solve(Nlp& nlp, const Eigen::VectorXd& z_start, const SolverOptions& options) const override;

 private:
  std::string python_;
};

/// SNOPT from where there is one: the user's own library if it is named or is found as libsnopt7.so, else Drake's.
/// Throws InputError if the library that is named cannot be used.
std::unique_ptr<NlpSolver> make_snopt(const std::optional<std::string>& library, const std::string& python);

}  // namespace prowl::cli
