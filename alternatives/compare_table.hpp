#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "alternatives/run_formulation.hpp"

namespace prowl {

/// One line of the table of `prowl compare`: a combination of choices and its result.
struct ComparedRun {
  Formulation formulation;
  std::string solver;                      ///< as on the command line
  int intervals = 0, nodes = 0;            ///< of the mesh
  std::optional<FormulationRun> run = {};  ///< nullopt if the choices are incompatible, or evaluation failed
  std::string reason = {};                 ///< why there is no run
};

/// Request and results of `prowl compare`.
struct CompareRecord {
  std::string task, robot;  ///< names
  SolverOptions options;    ///< of each run
  HessianKind hessian = HessianKind::exact;
  std::string guess = guess_names().front();
  int asked = 0;                                     ///< number of requested runs; more than `runs` if interrupted
  std::map<std::string, std::string> versions = {};  ///< "prowl" -> "0.1.0", "Ipopt" -> ...
  std::vector<ComparedRun> runs = {};

  bool interrupted() const { return static_cast<int>(runs.size()) < asked; }
};

// One table in three forms (docs/formulations.md), with the same lines and columns in the same
// order. Markdown is for readers: it lists common choices above the table, rounds, and omits
// explanatory columns.
std::string compare_markdown(const CompareRecord& record);
/// Numbers in SI units with all digits; missing values are empty cells.
std::string compare_csv(const CompareRecord& record);
/// The same; missing and non-finite values are null.
std::string compare_json(const CompareRecord& record);

}  // namespace prowl
