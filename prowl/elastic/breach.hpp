#pragma once

#include <string>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/transcription/node/motion_limit.hpp"

namespace prowl {

/// A limit that gives way in an elastic solve, at its worst node.
struct Breach {
  LimitKind kind = LimitKind::friction;
  int phase = 0;
  double time = 0.0;    ///< in the motion of the elastic solve [s]
  std::string subject;  ///< contact, joint, or entry of a goal
  double amount = 0.0;  ///< violation > 0, in `unit`
  std::string unit;
  double relative = 0.0;  ///< amount / MotionLimit::size
  double total = 0.0;     ///< price over all nodes
};

/// "phase 2 'swing', lh_foot, friction at 0.410 s: 37 N short".
std::string in_words(const Breach& breach, const MotionProblem& problem);

/// "phase 2 'swing'", or "phase 2" if the phase has no name of its own.
std::string phase_in_words(const MotionProblem& problem, int phase);

}  // namespace prowl
