#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "prowl/motion/motion_problem.hpp"

namespace prowl {

/// A number of the task or of the robot that could be another: what a change turns. Its amount a >= 0 is the logarithm
/// of a ratio, so that all knobs have one scale: friction times e^a, duration times or by e^a, a goal e^-a of its way
/// from the start. 0 changes nothing.
struct Knob {
  std::string kind;        ///< a LimitKind, or "duration"
  int phase = -1;          ///< that it is about; -1 for the whole motion
  std::string subject;     ///< surface, goal, contact, joint or phase; "" for all
  double most = 0.0;       ///< largest amount worth a try
  bool is_factor = false;  ///< value() is what the limits of several joints, which may differ, are multiplied with
  bool is_asked = false;   ///< by the task (goal, place, clearance, duration); else a limit of the robot or the ground
  double weight = 1.0;     ///< amounts of different kinds are compared after multiplication with this
  std::string unit;
  /// The number, in `unit`, which goes with e^a or e^-a but where a range may not be so wide; of several the one that
  /// changes most, of limits of several joints the factor.
  std::function<double(double amount)> value;
  std::function<MotionProblem(double amount)> problem;  ///< may throw InputError
  std::function<std::string(double amount)> words =
      {};  ///< the number as a file says it, with unit, where value() is another; may be empty
  std::function<std::string(double amount)> besides = {};  ///< what else it turns; may be empty
};

/// "torque limits of all joints x 1.5", "friction of floor 0.61", "goal 1, base z 0.254 m": what is tried.
std::string in_words(const Knob& knob, double amount);

/// What needs more than twenty times the torque is another robot. What a file asks may be in millimetres.
inline const double kMostAmount = std::log(20.0), kMostOfWay = std::log(1000.0);

// Forces and torques of a motion go with the way and with the square of the time, so that too little friction or torque
// is mended by a nearer goal or a longer phase, too, and by a smaller ratio of times. Where such a change is about
// equal to that of a limit, the limit is what is missing: a task that asks too much breaks several limits at once, and
// no change of one of them mends it.
inline constexpr double kWeightOfWay = 1.25;
inline constexpr double kWeightOfTime = 2.5;
inline constexpr double kWeightOfAllTimes = 3.0;

/// All knobs that a problem has: friction of each surface in use, if below that of rubber on dry concrete; duration of
/// each phase (of five or fewer), longer, and shorter on fewer than three contacts, and of all of them together;
/// torque, velocity and position limits of all joints; each goal that is away from the start; each place that a contact
/// has to land on, if it is known where it was before; swing clearance. They refer to the problem, which must outlive
/// them.
std::vector<Knob> knobs_of(const MotionProblem& problem);

/// That amount or a little more, at which value() has three digits and no more, so that what is printed is what was
/// solved.
double printable_amount(const Knob& knob, double amount);

}  // namespace prowl
