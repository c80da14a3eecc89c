#pragma once

#include <string>

#include "prowl/files/text_file.hpp"

namespace prowl {

/// Translates a complaint of validate() about a MotionProblem into the words of its task file:
/// "task.toml:12:1: start: contact 'lf_foot' ..." for "boundary_constraints[0].q_ref: contact
/// 'lf_foot' ...".
std::string in_terms_of_the_file(const SourceText& task_file, const std::string& complaint);

}  // namespace prowl
