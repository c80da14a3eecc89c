#include "prowl/plan_folder/mjcf_document.hpp"

#include <fmt/format.h>

#include "prowl/error.hpp"

namespace prowl {

std::unique_ptr<tinyxml2::XMLDocument> parse_mjcf(const std::string& text, const std::string& robot) {
  auto document = std::make_unique<tinyxml2::XMLDocument>();
  document->Parse(text.c_str());
  const tinyxml2::XMLElement* const root = document->RootElement();
  if (!root || !root->FirstChildElement("worldbody")) {
    throw InputError(fmt::format("robot '{}': not a model of MuJoCo", robot));
  }
  return document;
}

std::string mjcf_text(const tinyxml2::XMLDocument& document) {
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

}  // namespace prowl
