#include "prowl/model/urdf/urdf_check.hpp"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml2.h>

#include <algorithm>
#include <limits>
#include <map>
#include <string_view>
#include <vector>

#include "prowl/error.hpp"
#include "prowl/model/urdf/urdf_location.hpp"
#include "prowl/model/urdf/urdf_shapes.hpp"
#include "prowl/text/name_check.hpp"
#include "prowl/text/nearest_name.hpp"
#include "prowl/text/shown_text.hpp"

namespace prowl {

namespace {

using tinyxml2::XMLElement;
using Location = UrdfLocation;

constexpr std::size_t kMaxLinks = 1000;  // a chain of 3,000 keeps Pinocchio busy for more than 20 s
// Humanoids with both hands have fewer than 100. Pinocchio keeps four tensors of nv³ numbers: 64 MB here, 4 GB at 500.
constexpr int kMaxMovingJoints = 120;

void check_link(const Location& location, const XMLElement& link, const std::string& name,
                std::vector<UrdfLink>& result) {
  check_shapes(location, link);
  const XMLElement* inertial = link.FirstChildElement("inertial");
  if (inertial == nullptr) return;  // a massless frame
  check_urdf_origin(location, *inertial);
  const XMLElement* mass = inertial->FirstChildElement("mass");
  const XMLElement* inertia = inertial->FirstChildElement("inertia");
  if (mass == nullptr || inertia == nullptr) location.refuse(*inertial, "<inertial> needs both <mass> and <inertia>");
  const double kg = urdf_number(location, *mass, "value");
  if (kg < 0.0) location.refuse(*mass, fmt::format("<mass value=\"{}\">: expected mass >= 0 [kg]", kg));
  const auto moment = [&](const char* i) { return urdf_number(location, *inertia, i); };
  Eigen::Matrix3d I;
  I << moment("ixx"), moment("ixy"), moment("ixz"),  //
      moment("ixy"), moment("iyy"), moment("iyz"),   //
      moment("ixz"), moment("iyz"), moment("izz");
  result.push_back({name, kg, I});
}

void check_moving_joint(const Location& location, const XMLElement& joint, const std::string& type) {
  if (type == "continuous") {
    location.refuse(joint,
                    "type continuous is not supported; give it limits (for example lower=\"-6.3\" upper=\"6.3\") and "
                    "type=\"revolute\", or name it in locked_joints of the robot file");
  }
  if (type == "floating") {
    location.refuse(joint,
                    "type floating is not supported; remove this joint and its parent link: Prowl itself lets the "
                    "root link float");
  }
  if (type != "revolute" && type != "prismatic") {
    location.refuse(joint,
                    fmt::format("type {} is not supported; expected revolute, prismatic or fixed{}", shown(type),
                                type == "planar" ? " (model it as two prismatic joints and a revolute one)" : ""));
  }
  const XMLElement* axis = joint.FirstChildElement("axis");  // 1 0 0 if not given
  if (axis != nullptr && check_urdf_vector(location, axis, "xyz") < 1e-6) {
    location.refuse(*axis, fmt::format("<axis xyz=\"{}\">: expected a direction, for example 0 0 1",
                                       axis->Attribute("xyz") != nullptr ? shown(axis->Attribute("xyz")) : ""));
  }
  const XMLElement* limit = joint.FirstChildElement("limit");
  if (limit == nullptr) {
    location.refuse(joint, "no <limit>; expected <limit lower=\"...\" upper=\"...\" velocity=\"...\" effort=\"...\"/>");
  }
  constexpr double kAny = std::numeric_limits<double>::infinity();
  for (const char* name : {"velocity", "effort"}) {
    const double value = urdf_number(location, *limit, name, kAny);
    if (value < 0.0) location.refuse(*limit, fmt::format("<limit {}=\"{}\">: expected a number > 0", name, value));
  }
  for (const char* name : {"lower", "upper"}) {  // 0 if not given
    if (limit->Attribute(name) != nullptr) urdf_number(location, *limit, name, kAny);
  }
  const XMLElement* losses = joint.FirstChildElement("dynamics");
  if (losses == nullptr) return;
  for (const char* name : {"damping", "friction"}) {  // 0 if not given
    if (losses->Attribute(name) == nullptr) continue;
    const double value = urdf_number(location, *losses, name);
    if (value < 0.0) location.refuse(*losses, fmt::format("<dynamics {}=\"{}\">: expected a number >= 0", name, value));
  }
}

void check_mimic(const Location& location, const XMLElement& mimic) {
  urdf_text(location, mimic, "joint");
  for (const char* name : {"multiplier", "offset"}) {  // 1 and 0 if not given
    if (mimic.Attribute(name) != nullptr) urdf_number(location, mimic, name);
  }
}

/// Parent link of every link that is the child of a joint.
using Parents = std::map<std::string, std::string>;

void check_joint(const Location& location, const XMLElement& joint, const std::vector<std::string>& links,
                 bool is_locked, Parents& parents) {
  std::string ends[2];
  for (const int i : {0, 1}) {
    const char* role = i == 0 ? "parent" : "child";
    const XMLElement* end = joint.FirstChildElement(role);
    if (end == nullptr) location.refuse(joint, fmt::format("no <{} link=\"...\"/>", role));
    ends[i] = urdf_text(location, *end, "link");
    if (std::find(links.begin(), links.end(), ends[i]) == links.end()) {
      location.refuse(*end,
                      fmt::format("{} link '{}' does not exist{}", role, shown(ends[i]), did_you_mean(ends[i], links)));
    }
  }
  if (!parents.emplace(ends[1], ends[0]).second) {
    location.refuse(joint, fmt::format("link '{}' is already the child of another joint; expected a tree", ends[1]));
  }
  check_urdf_origin(location, joint);
  const std::string type = urdf_text(location, joint, "type");
  if (type != "fixed" && !is_locked) check_moving_joint(location, joint, type);
}

void check_tree(const Location& location, const XMLElement& root, const std::vector<std::string>& links,
                const Parents& parents) {
  std::vector<std::string> roots;
  for (const std::string& link : links) {
    if (!parents.contains(link)) roots.push_back(link);
    const std::string* ancestor = &link;
    for (std::size_t steps = 0; parents.contains(*ancestor); ++steps) {
      if (steps > links.size()) location.refuse(root, fmt::format("the joints form a loop at link '{}'", *ancestor));
      ancestor = &parents.at(*ancestor);
    }
  }
  if (roots.size() != 1) {
    location.refuse(root, fmt::format("{} links are not the child of a joint ({}); expected exactly one, the base",
                                      roots.size(), shown(fmt::format("{}", fmt::join(roots, ", ")))));
  }
}

const XMLElement& root_of(const std::string& file, const std::string& xml, tinyxml2::XMLDocument& document) {
  if (document.Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS) {
    throw InputError(fmt::format("{}:{}: not an XML file ({}); expected a URDF", file,
                                 std::max(1, document.ErrorLineNum()),
                                 tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID())));
  }
  if (document.RootElement() == nullptr) {
    throw InputError(fmt::format("{}:1: no XML element; expected a URDF, <robot name=\"...\">", file));
  }
  const XMLElement& root = *document.RootElement();
  const Location location{file, fmt::format("<{}>", shown(root.Name()))};
  if (std::string(root.Name()) != "robot") location.refuse(root, "not a URDF; expected <robot name=\"...\">");
  urdf_text(location, root, "name");
  for (const tinyxml2::XMLNode* n = document.FirstChild(); n != nullptr; n = n->NextSibling()) {
    // Prowl does not expand entities: a text with one would be wrong.
    if (n->ToUnknown() == nullptr || std::string_view(n->Value()).find("<!ENTITY") == std::string_view::npos) continue;
    throw InputError(
        fmt::format("{}:{}: entities (<!ENTITY ...>) are not allowed; write out their text", file, n->GetLineNum()));
  }
  for (const XMLElement* e = root.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    if (std::string(e->Name()).starts_with("xacro:")) {
      location.refuse(*e, "this is a xacro file; expected its URDF: xacro FILE > robot.urdf");
    }
  }
  return root;
}

}  // namespace

UrdfFacts check_urdf(const std::string& file, const std::string& xml, const std::vector<std::string>& locked) {
  console_bridge::noOutputHandler();  // silences urdfdom on stderr: this check reports mistakes
  tinyxml2::XMLDocument document;
  const XMLElement& root = root_of(file, xml, document);
  const Location robot{file, fmt::format("robot '{}'", shown(root.Attribute("name")))};

  UrdfFacts result;
  std::vector<std::string> links;
  std::map<std::string, int> line_of;  // where a name was used first
  const auto visit = [&](const char* kind, const auto& check) {
    line_of.clear();
    for (const XMLElement* e = root.FirstChildElement(kind); e != nullptr; e = e->NextSiblingElement(kind)) {
      const std::string name = urdf_text(robot, *e, "name");
      if (!is_name(name)) robot.refuse(*e, fmt::format("this name of a {} is not allowed; need {}", kind, kNameRule));
      const Location location{file, fmt::format("{} '{}'", kind, name)};
      if (const auto [first, is_new] = line_of.emplace(name, e->GetLineNum()); !is_new) {
        location.refuse(*e, fmt::format("the name is already used in line {}; expected unique names", first->second));
      }
      check(location, *e, name);
    }
  };
  visit("link", [&](const Location& location, const XMLElement& link, const std::string& name) {
    if (links.size() == kMaxLinks) location.refuse(link, fmt::format("more than {} links are not allowed", kMaxLinks));
    if (name == "universe") location.refuse(link, "Pinocchio uses this name for the world; expected another");
    check_link(location, link, name, result.links);
    links.push_back(name);
  });
  if (links.empty()) robot.refuse(root, "no <link>; expected at least the base");
  Parents parents;
  int moving = 0;
  visit("joint", [&](const Location& location, const XMLElement& joint, const std::string& name) {
    const XMLElement* const copies = joint.FirstChildElement("mimic");
    const bool is_locked = std::ranges::find(locked, name) != locked.end();
    check_joint(location, joint, links, is_locked, parents);
    if (urdf_text(location, joint, "type") == "fixed") return;
    if (copies != nullptr) {
      check_mimic(location, *copies);
      result.mimics.push_back(name);
    }
    if (copies != nullptr || is_locked) return;
    if (++moving > kMaxMovingJoints) {
      location.refuse(joint, fmt::format("more than {} moving joints are not allowed; fix those that the motion does "
                                         "not need",
                                         kMaxMovingJoints));
    }
  });
  check_tree(robot, root, links, parents);
  return result;
}

}  // namespace prowl
