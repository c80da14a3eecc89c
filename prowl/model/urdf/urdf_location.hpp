#pragma once

// Internal to model: strict reading of numbers in a URDF. Shows tinyxml2: include it only in .cpp files.
#include <tinyxml2.h>

#include <limits>
#include <string>

namespace prowl {

/// One link or joint (or the whole robot), for messages: "file:line: joint 'name'".
struct UrdfLocation {
  const std::string& file;
  std::string element;

  /// Throws InputError.
  [[noreturn]] void refuse(const tinyxml2::XMLElement& at, const std::string& problem) const;
};

constexpr double kLargestInUrdf = 1e9;  ///< of any length, mass, inertia [SI]; their products stay finite

/// The required attribute `name` of `at` as text, not empty.
std::string urdf_text(const UrdfLocation& location, const tinyxml2::XMLElement& at, const char* name);

/// The same as one finite number.
double urdf_number(const UrdfLocation& location, const tinyxml2::XMLElement& at, const char* name,
                   double largest = kLargestInUrdf);

/// Refuses an attribute `name` of the element that is not `size` (3 or 4) finite numbers. Attribute and element
/// (nullptr) may be missing. Returns the largest absolute value.
double check_urdf_vector(const UrdfLocation& location, const tinyxml2::XMLElement* at, const char* name, int size = 3);

/// Checks the <origin> of `parent`, which may be missing.
void check_urdf_origin(const UrdfLocation& location, const tinyxml2::XMLElement& parent);

}  // namespace prowl
