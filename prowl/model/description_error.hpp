#pragma once

#include <string>
#include <utility>

#include "prowl/error.hpp"

namespace prowl {

/// Thrown for an invalid RobotDescription; contains the key of the robot file that is wrong.
class DescriptionError : public InputError {
 public:
  DescriptionError(std::string key, const std::string& message) : InputError(message), key_(std::move(key)) {}
  /// "contact[3].frame", "nominal.joints.NAME", "limits.NAME"; "urdf" for limits that the file does not replace.
  const std::string& key() const { return key_; }

 private:
  std::string key_;
};

}  // namespace prowl
