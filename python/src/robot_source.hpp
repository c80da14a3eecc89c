#pragma once

#include <nanobind/nanobind.h>

#include "prowl/files/text_file.hpp"
#include "prowl/model/robot_model.hpp"

namespace prowl::python {

/// Attaches the source file to a prowl.Robot (Robot.path, Robot.text), and returns it.
nanobind::object with_source(nanobind::object robot, const SourceText& file);

/// prowl.Robot of `robot`, kept alive by `owner`, with its source file.
nanobind::object robot_of(nanobind::handle owner, const RobotModel& robot, const SourceText& file);

}  // namespace prowl::python
