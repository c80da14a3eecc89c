#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "prowl/certificate/certificate_grade.hpp"
#include "prowl/files/text_file.hpp"

namespace prowl {

/// A value that a motion of a library has for one draw.
using DrawnValue = std::variant<double, bool, std::string>;  ///< of lists and tables the TOML text

/// The same as it stands in the task file.
struct Drawn {
  DrawnValue value;
  std::string text;  ///< TOML
};

/// A random choice of a job: the same value for each of its keys of the task file.
struct Draw {
  enum class Kind { uniform, log_uniform, normal, one_of };
  std::vector<std::string> keys;  ///< paths: "goal[0].base_displacement_m[2]"
  Kind kind = Kind::uniform;
  double first = 0.0, second = 0.0;  ///< lower and upper end; mean and standard deviation of `normal`
  std::vector<Drawn> choices;        ///< of `one_of`
  std::string location;              ///< "file:line:column: draw[0]: ", for messages

  const std::string& name() const { return keys.front(); }
};

/// A library of motions to plan: a task, of which some keys are drawn at random for each motion (docs/batch.md).
struct Job {
  SourceText file;
  SourceText task_file;
  int count = 0;                                     ///< motions
  std::uint64_t seed = 1;                            ///< of the draws and of the simulations
  CertificateGrade grade = CertificateGrade::draft;  ///< that a motion must have
  double rate = 50.0;                                ///< samples of a motion per second [Hz]
  bool gains = false, simulation = false;            ///< keep gains; simulate under the strict judge
  int shard = 250;                                   ///< motions in one file
  double hang_seconds = 600.0;                       ///< after which a motion counts as unfinished [s]
  std::vector<Draw> draws;
};

/// TOML texts of both ends of a draw, or of all its choices.
std::vector<std::string> end_texts(const Draw& draw);

/// The values of all draws for motion `index`, by (seed, index, position of the draw) alone.
std::vector<DrawnValue> drawn_values(const Job& job, int index);

/// Text of the task file of motion `index`: that of the job with the drawn values. Throws InputError if a key path has
/// no place in it.
std::string drawn_task_text(const Job& job, int index);

}  // namespace prowl
