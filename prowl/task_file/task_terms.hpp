#pragma once

// Reads [[term]] of a task file. Not installed: exposes toml++.
#include <optional>
#include <vector>

#include "prowl/mesh/mesh.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/task_file/own_terms.hpp"
#include "prowl/task_file/toml/toml_value.hpp"

namespace prowl {

/// Finds the terms of one's own that a task file uses.
class OwnTermReader {
 public:
  /// `folder`: of the task file. Both must outlive the reader.
  OwnTermReader(const OwnTerms& own_terms, std::filesystem::path folder)
      : own_terms_(own_terms), folder_(std::move(folder)) {}

  /// The term of the keys own and library of [[term]].
  std::shared_ptr<const Term> read(const TomlTable& table) const;

 private:
  const OwnTerms& own_terms_;
  std::filesystem::path folder_;
};

/// One use for each [[term]]. With a mesh, which has equal steps in each phase, both ends of each are at nodes.
std::vector<TermUse> read_terms(const TomlTable& root, const RobotModel& robot, const std::vector<Phase>& phases,
                                const std::optional<Mesh>& mesh, const OwnTermReader& own_terms);

}  // namespace prowl
