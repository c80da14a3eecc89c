#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "alternatives/run_formulation.hpp"

namespace prowl {

/// One line of the table of `prowl compare`: a combination of choices, and what came of it.
struct ComparedRun {
  Formulation formulation;
  std::string solver;                      ///< as at the command line
  int intervals = 0, nodes = 0;            ///< of the mesh
  std::optional<FormulationRun> run = {};  ///< none if the choices do not go together, or nothing could be evaluated
  std::string reason = {};                 ///< why there is none
};

/// What `prowl compare` was asked for, and what came out.
struct CompareRecord {
  std::string task, robot;  ///< names
  SolverOptions options;    ///< of each run
  HessianKind hessian = HessianKind::exact;
  std::string guess = guess_names().front();
  int asked = 0;                                     ///< lines; more than there are below if it was interrupted
  std::map<std::string, std::string> versions = {};  ///< "prowl" -> "0.1.0", "Ipopt" -> ...
  std::vector<ComparedRun> runs = {};

  bool interrupted() const { return static_cast<int>(runs.size()) < asked; }
};

// One table in three forms (docs/formulations.md): the same lines, and the same columns in the same order, but that
// Markdown is to be read: it says above the table what is the same in all lines, rounds, and leaves out what explains a
// figure.
std::string compare_markdown(const CompareRecord& record);
/// Numbers in SI units, so that they read back as they were; cells are empty where there is nothing to say.
std::string compare_csv(const CompareRecord& record);
/// The same with null for empty, and for what is not finite.
std::string compare_json(const CompareRecord& record);

}  // namespace prowl
