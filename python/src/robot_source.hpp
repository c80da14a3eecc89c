#pragma once

#include <nanobind/nanobind.h>

#include "prowl/files/text_file.hpp"
#include "prowl/model/robot_model.hpp"

namespace prowl::python {

/// The same prowl.Robot, which from now on knows the file that it was read from (Robot.path, Robot.text).
nanobind::object with_source(nanobind::object robot, const SourceText& file);

/// Robot `robot`, kept alive by `owner`, with the file that it was read from.
nanobind::object robot_of(nanobind::handle owner, const RobotModel& robot, const SourceText& file);

}  // namespace prowl::python
