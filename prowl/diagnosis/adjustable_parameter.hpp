#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "prowl/motion/motion_problem.hpp"

namespace prowl {

/// A number of the task or of the robot that a diagnosis may change. Its amount a >= 0 is the logarithm of a ratio, so
/// all parameters share one scale: friction times e^a, duration times e^a or e^-a, a goal at e^-a of its distance from
/// the start. 0 changes nothing.
struct AdjustableParameter {
  std::string kind;        ///< a LimitKind, or "duration"
  int phase = -1;          ///< -1 for the whole motion
  std::string subject;     ///< surface, goal, contact, joint or phase; "" for all
  double most = 0.0;       ///< largest amount to try
  bool is_factor = false;  ///< value() is a common factor on the limits of several joints
  bool is_asked = false;   ///< a demand of the task (goal, place, clearance, duration), not a limit of robot or ground
  double weight = 1.0;     ///< amounts of different kinds are compared times this weight
  std::string unit;
  /// The number in `unit`: times e^a or e^-a, unless a range cannot be that wide; the number that changes
  /// most if there are several, or the factor on limits of several joints.
  std::function<double(double amount)> value;
  std::function<MotionProblem(double amount)> problem;  ///< may throw InputError
  std::function<std::string(double amount)> words =
      {};  ///< the number as in a file, with unit, if value() is another; may be empty
  std::function<std::string(double amount)> besides = {};  ///< its side effects; may be empty
};

/// "torque limits of all joints x 1.5", "friction of floor 0.61", "goal 1, base z 0.254 m".
std::string in_words(const AdjustableParameter& parameter, double amount);

/// With more than twenty times the torque it is another robot. A goal may be in millimetres by mistake.
inline const double kMostAmount = std::log(20.0), kMostOfWay = std::log(1000.0);

// Forces and torques scale with distance and 1 / time², so a nearer goal or a longer phase also cures a lack of
// friction or torque, time with a smaller ratio. If such a change is about as large as that of a limit, the limit is
// the cause: a task that asks too much breaks several limits at once, and no change of one of them suffices.
inline constexpr double kWeightOfWay = 1.25;
inline constexpr double kWeightOfTime = 2.5;
inline constexpr double kWeightOfAllTimes = 3.0;

/// All parameters of a problem: friction of each surface in use, if below that of rubber on dry concrete; duration of
/// each phase (of five or fewer), longer, or shorter with fewer than three contacts, and of all phases together;
/// torque, velocity and position limits of all joints; asked_parameters(). They refer to the problem, which must
/// outlive them.
std::vector<AdjustableParameter> adjustable_parameters(const MotionProblem& problem);

/// That amount, or slightly more, so that value() has at most three digits: the printed number is the solved one.
double printable_amount(const AdjustableParameter& parameter, double amount);

}  // namespace prowl
