#pragma once

#include <tinyxml2.h>

#include <memory>
#include <string>

namespace prowl {

/// A model of MuJoCo, to add to. Throws InputError that names the robot for a text without <worldbody>.
std::unique_ptr<tinyxml2::XMLDocument> parse_mjcf(const std::string& text, const std::string& robot);

std::string mjcf_text(const tinyxml2::XMLDocument& document);

}  // namespace prowl
