#pragma once

#include <memory>
#include <string>

#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

class SnoptLibrary;

/// SNOPT 7 (Gill, Murray, Saunders 2005: sequential quadratic programming, quasi-Newton), with exact sparse first
/// derivatives, out of the user's own library: SNOPT is commercial. Prowl's authors have no such library; it was tested
/// against a double with the published interface (tests/solvers/snopt_double.cpp). The tests of SNOPT itself use
/// Drake's (python/prowl/snopt.py).
///
/// - The print file and the summary are switched off. Options are SNOPT's own but for limits, tolerances and
/// derivatives.
/// - SNOPT takes a row for met within tolerance x |z|; it is given a tolerance that is the smaller by |z_start|.
/// - An evaluation that fails at a trial point shortens the step.
/// - Interrupt and time are looked at with each evaluation; on_iteration is told of evaluations.
/// - Stopped early, it returns its best iterate: of least violation, and of least cost among those within tolerance.
/// - One solve at a time in a process: the interface has work space of its own. Others wait.
class SnoptSolver : public NlpSolver {
 public:
  /// `library`: a path, or a name that the dynamic linker looks for.
  explicit SnoptSolver(const std::string& library = "libsnopt7.so");
  ~SnoptSolver() override;

  /// What is wrong with the library; nothing if it can be used.
  const std::optional<std::string>& why_unavailable() const;

  std::string name() const override;
  std::string version() const override;
  /// Also where the library is missing or lacks a function.
  std::optional<std::string> why_unsupported(Nlp& nlp) const override;
  /// Throws InputError if an option or the size of z_start makes no sense, or if the library cannot be used.
  SolveResult solve(Nlp& nlp, const Eigen::VectorXd& z_start, const SolverOptions& options) const override;

 private:
  std::unique_ptr<SnoptLibrary> library_;
};

}  // namespace prowl
