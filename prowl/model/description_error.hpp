#pragma once

#include <string>
#include <utility>

#include "prowl/error.hpp"

namespace prowl {

/// Thrown for a RobotDescription that is no robot: also says which key of a robot file it comes from.
class DescriptionError : public InputError {
 public:
  DescriptionError(std::string key, const std::string& message) : InputError(message), key_(std::move(key)) {}
  /// "contact[3].frame", "nominal.joints.NAME", "limits.NAME"; "urdf" for what the file does not replace.
  const std::string& key() const { return key_; }

 private:
  std::string key_;
};

}  // namespace prowl
