#pragma once

#include <string>

#include "prowl/diagnosis/diagnosis.hpp"

namespace prowl {

/// One line in the robot's words: what is missing, where and when, and with what it would be solvable.
std::string diagnosis_headline(const Diagnosis& diagnosis, const MotionProblem& problem);

/// The whole of it as text: headline, proofs and doubts, what gives way, changes.
std::string diagnosis_text(const Diagnosis& diagnosis, const MotionProblem& problem);

/// The same as a JSON object (docs/diagnose.md).
std::string diagnosis_json(const Diagnosis& diagnosis, const MotionProblem& problem);

}  // namespace prowl
