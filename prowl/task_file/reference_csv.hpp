#pragma once

#include "prowl/files/text_file.hpp"
#include "prowl/motion/reference_motion.hpp"

namespace prowl {

/// Largest file with a reference [bytes]: ten minutes of a humanoid at 50 Hz.
constexpr std::size_t kLongestReference = std::size_t{32} << 20;

/// The reference of a CSV file with the columns time_s, base_px_m ... base_qw and q_JOINT_rad, as those of a plan's
/// trajectory (docs/plan-directory.md); other columns are ignored. Times count from the first row; of rows at one time
/// the last counts. Throws InputError "file:line: column: ..." for a missing column, numbers that are not finite,
/// quaternions that are not of length one, and times that run backwards.
ReferenceMotion read_reference_csv(const RobotModel& robot, const SourceText& source);

}  // namespace prowl
