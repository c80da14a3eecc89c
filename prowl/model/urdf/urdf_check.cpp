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
using Place = UrdfPlace;

constexpr std::size_t kMaxLinks = 1000;  // a chain of 3,000 keeps Pinocchio busy for more than 20 s
// Humanoids with both hands have fewer than 100. Pinocchio keeps four tensors of nv³ numbers: 64 MB here, 4 GB at 500.
constexpr int kMaxMovingJoints = 120;

void check_link(const Place& place, const XMLElement& link, const std::string& name, std::vector<UrdfLink>& result) {
  check_shapes(place, link);
  const XMLElement* inertial = link.FirstChildElement("inertial");
  if (inertial == nullptr) return;  // a massless frame
  check_urdf_origin(place, *inertial);
  const XMLElement* mass = inertial->FirstChildElement("mass");
  const XMLElement* inertia = inertial->FirstChildElement("inertia");
  if (mass == nullptr || inertia == nullptr) place.refuse(*inertial, "<inertial> needs both <mass> and <inertia>");
  const double kg = urdf_number(place, *mass, "value");
  if (kg < 0.0) place.refuse(*mass, fmt::format("<mass value=\"{}\">: expected mass >= 0 [kg]", kg));
  const auto moment = [&](const char* i) { return urdf_number(place, *inertia, i); };
  Eigen::Matrix3d I;
  I << moment("ixx"), moment("ixy"), moment("ixz"),  //
      moment("ixy"), moment("iyy"), moment("iyz"),   //
      moment("ixz"), moment("iyz"), moment("izz");
  result.push_back({name, kg, I});
}

void check_moving_joint(const Place& place, const XMLElement& joint, const std::string& type) {
  if (type == "continuous") {
    place.refuse(joint,
                 "type continuous is not supported; give it limits (for example lower=\"-6.3\" upper=\"6.3\") and "
                 "type=\"revolute\"");
  }
  if (type == "floating") {
    place.refuse(joint,
                 "type floating is not supported; remove this joint and its parent link: Prowl itself lets the "
                 "root link float");
  }
  if (type != "revolute" && type != "prismatic") {
    place.refuse(joint, fmt::format("type {} is not supported; expected revolute, prismatic or fixed{}", shown(type),
                                    type == "planar" ? " (model it as two prismatic joints and a revolute one)" : ""));
  }
  if (const XMLElement* mimic = joint.FirstChildElement("mimic")) {
    place.refuse(*mimic,
                 "mimic joints are not supported: every moving joint has its own actuator; remove <mimic>, or "
                 "make the joint fixed");
  }
  const XMLElement* axis = joint.FirstChildElement("axis");  // 1 0 0 if not given
  if (axis != nullptr && check_urdf_vector(place, axis, "xyz") < 1e-6) {
    place.refuse(*axis, fmt::format("<axis xyz=\"{}\">: expected a direction, for example 0 0 1",
                                    axis->Attribute("xyz") != nullptr ? shown(axis->Attribute("xyz")) : ""));
  }
  const XMLElement* limit = joint.FirstChildElement("limit");
  if (limit == nullptr) {
    place.refuse(joint, "no <limit>; expected <limit lower=\"...\" upper=\"...\" velocity=\"...\" effort=\"...\"/>");
  }
  constexpr double kAny = std::numeric_limits<double>::infinity();
  for (const char* name : {"velocity", "effort"}) {
    const double value = urdf_number(place, *limit, name, kAny);
    if (value < 0.0) place.refuse(*limit, fmt::format("<limit {}=\"{}\">: expected a number > 0", name, value));
  }
  for (const char* name : {"lower", "upper"}) {  // 0 if not given
    if (limit->Attribute(name) != nullptr) urdf_number(place, *limit, name, kAny);
  }
}

/// Parent link of every link that is the child of a joint.
using Parents = std::map<std::string, std::string>;

void check_joint(const Place& place, const XMLElement& joint, const std::vector<std::string>& links, Parents& parents) {
  std::string ends[2];
  for (const int i : {0, 1}) {
    const char* role = i == 0 ? "parent" : "child";
    const XMLElement* end = joint.FirstChildElement(role);
    if (end == nullptr) place.refuse(joint, fmt::format("no <{} link=\"...\"/>", role));
    ends[i] = urdf_text(place, *end, "link");
    if (std::find(links.begin(), links.end(), ends[i]) == links.end()) {
      place.refuse(*end,
                   fmt::format("{} link '{}' does not exist{}", role, shown(ends[i]), did_you_mean(ends[i], links)));
    }
  }
  if (!parents.emplace(ends[1], ends[0]).second) {
    place.refuse(joint, fmt::format("link '{}' is already the child of another joint; expected a tree", ends[1]));
  }
  check_urdf_origin(place, joint);
  const std::string type = urdf_text(place, joint, "type");
  if (type != "fixed") check_moving_joint(place, joint, type);
}

void check_tree(const Place& place, const XMLElement& root, const std::vector<std::string>& links,
                const Parents& parents) {
  std::vector<std::string> roots;
  for (const std::string& link : links) {
    if (!parents.contains(link)) roots.push_back(link);
    const std::string* ancestor = &link;
    for (std::size_t steps = 0; parents.contains(*ancestor); ++steps) {
      if (steps > links.size()) place.refuse(root, fmt::format("the joints form a loop at link '{}'", *ancestor));
      ancestor = &parents.at(*ancestor);
    }
  }
  if (roots.size() != 1) {
    place.refuse(root, fmt::format("{} links are not the child of a joint ({}); expected exactly one, the base",
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
  const Place place{file, fmt::format("<{}>", shown(root.Name()))};
  if (std::string(root.Name()) != "robot") place.refuse(root, "not a URDF; expected <robot name=\"...\">");
  urdf_text(place, root, "name");
  for (const tinyxml2::XMLNode* n = document.FirstChild(); n != nullptr; n = n->NextSibling()) {
    // Prowl does not expand entities: a text with one would be wrong.
    if (n->ToUnknown() == nullptr || std::string_view(n->Value()).find("<!ENTITY") == std::string_view::npos) continue;
    throw InputError(
        fmt::format("{}:{}: entities (<!ENTITY ...>) are not allowed; write out their text", file, n->GetLineNum()));
  }
  for (const XMLElement* e = root.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    if (std::string(e->Name()).starts_with("xacro:")) {
      place.refuse(*e, "this is a xacro file; expected its URDF: xacro FILE > robot.urdf");
    }
  }
  return root;
}

}  // namespace

std::vector<UrdfLink> check_urdf(const std::string& file, const std::string& xml) {
  console_bridge::noOutputHandler();  // silences urdfdom on stderr: this check reports mistakes
  tinyxml2::XMLDocument document;
  const XMLElement& root = root_of(file, xml, document);
  const Place robot{file, fmt::format("robot '{}'", shown(root.Attribute("name")))};

  std::vector<UrdfLink> result;
  std::vector<std::string> links;
  std::map<std::string, int> line_of;  // where a name was used first
  const auto visit = [&](const char* kind, const auto& check) {
    line_of.clear();
    for (const XMLElement* e = root.FirstChildElement(kind); e != nullptr; e = e->NextSiblingElement(kind)) {
      const std::string name = urdf_text(robot, *e, "name");
      if (!is_name(name)) robot.refuse(*e, fmt::format("this name of a {} is not allowed; need {}", kind, kNameRule));
      const Place place{file, fmt::format("{} '{}'", kind, name)};
      if (const auto [first, is_new] = line_of.emplace(name, e->GetLineNum()); !is_new) {
        place.refuse(*e, fmt::format("the name is already used in line {}; expected unique names", first->second));
      }
      check(place, *e, name);
    }
  };
  visit("link", [&](const Place& place, const XMLElement& link, const std::string& name) {
    if (links.size() == kMaxLinks) place.refuse(link, fmt::format("more than {} links are not allowed", kMaxLinks));
    if (name == "universe") place.refuse(link, "Pinocchio uses this name for the world; expected another");
    check_link(place, link, name, result);
    links.push_back(name);
  });
  if (links.empty()) robot.refuse(root, "no <link>; expected at least the base");
  Parents parents;
  int moving = 0;
  visit("joint", [&](const Place& place, const XMLElement& joint, const std::string&) {
    check_joint(place, joint, links, parents);
    if (urdf_text(place, joint, "type") == "fixed") return;
    if (++moving > kMaxMovingJoints) {
      place.refuse(joint, fmt::format("more than {} moving joints are not allowed; fix those that the motion does "
                                      "not need",
                                      kMaxMovingJoints));
    }
  });
  check_tree(robot, root, links, parents);
  return result;
}

}  // namespace prowl
