#pragma once

#include <string>

#include "prowl/certificate/certificate.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// What a motion does, for somebody who has not seen it: "HyQ crouches 17 cm and stands up again", "HyQ takes 16 steps
/// and moves 1.00 m forward". From the path of the base, seen along its heading at the start, and the contacts that
/// land, lift or are all in the air.
std::string motion_in_words(const MotionProblem& problem, const Trajectory& trajectory);

/// "Largest torque: 65 % of its limit at lf_kfe_joint."; "" if the certificate has no such check.
std::string torque_in_words(const Certificate& certificate);

/// "next to no margin: friction at lf_foot (0.08 N left), torque of lf_kfe_joint (100 % of its limit)": limits that a
/// motion which passes comes so near to that a small error of the model breaks it. Friction counts where the contact
/// carries load: before a foot lifts, force and margin both vanish. "" if there is margin everywhere.
std::string missing_margin(const MotionProblem& problem, const Trajectory& trajectory, const Certificate& certificate);

}  // namespace prowl
