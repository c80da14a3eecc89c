#pragma once

#include <memory>
#include <string>

#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

class SnoptLibrary;

/// SNOPT 7 (Gill, Murray, Saunders 2005: sequential quadratic programming, quasi-Newton), with
/// exact sparse first derivatives, from the user's own library: SNOPT is commercial. Tested only
/// against a double with the published interface (tests/solvers/snopt_double.cpp); tests of SNOPT
/// itself use Drake's copy (python/prowl/snopt.py).
///
/// - Print file and summary are switched off. Only limits, tolerances and derivative options differ
///   from SNOPT's defaults.
/// - SNOPT accepts a row within tolerance x |z|, so its tolerance is divided by |z_guess|.
/// - A failed evaluation at a trial point shortens the step.
/// - Interrupt and time are checked, and on_iteration is called, at each evaluation.
/// - Stopped early, it returns its best iterate: smallest violation, and smallest cost among those
///   within tolerance.
/// - One solve at a time per process, as the interface has global work space. Others wait.
class SnoptSolver : public NlpSolver {
 public:
  /// `library`: a path, or a name for the dynamic linker.
  explicit SnoptSolver(const std::string& library = "libsnopt7.so");
  ~SnoptSolver() override;

  /// Why the library cannot be used; nullopt if it can.
  const std::optional<std::string>& why_unavailable() const;

  std::string name() const override;
  std::string version() const override;
  /// Includes a missing library or function.
  std::optional<std::string> why_unsupported(Nlp& nlp) const override;
  /// Throws InputError for an invalid option or size of z_guess, or an unusable library.
  SolveResult solve(Nlp& nlp, const Eigen::VectorXd& z_guess, const SolverOptions& options) const override;

 private:
  std::unique_ptr<SnoptLibrary> library_;
};

}  // namespace prowl
