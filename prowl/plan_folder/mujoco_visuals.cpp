#include "prowl/plan_folder/mujoco_visuals.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <filesystem>
#include <tuple>

#include "prowl/model/body_tree.hpp"
#include "prowl/plan_folder/mjcf_document.hpp"

namespace prowl {
namespace {

using Kind = RobotVisual::Kind;
using tinyxml2::XMLElement;

constexpr double kThinnest = 1e-5;                  // [m]; MuJoCo refuses a size of 0
constexpr double kSmallestArea = 1e-9;              // [m^2]; MuJoCo refuses a mesh without area
constexpr std::size_t kFewestVertices = 4;          // MuJoCo refuses a mesh with less
const Eigen::Vector3d kNoColour(0.72, 0.73, 0.75);  // that of the report

template <class Numbers>
std::string numbers(const Numbers& values) {
  return fmt::format("{:.6g}", fmt::join(values, " "));
}

/// An element of MuJoCo's model by the name of its body.
void collect_bodies(XMLElement& parent, std::map<std::string, XMLElement*>& bodies) {
  for (XMLElement* body = parent.FirstChildElement("body"); body; body = body->NextSiblingElement("body")) {
    bodies[body->Attribute("name")] = body;
    collect_bodies(*body, bodies);
  }
}

double area(const VisualMesh& mesh, const Eigen::Vector3d& scale) {
  const auto corner = [&](std::size_t i) {
    const Eigen::Map<const Eigen::Vector3f> position(&mesh.positions[3 * mesh.triangles[i]]);
    return Eigen::Vector3d(scale.cwiseProduct(position.cast<double>()));
  };
  double sum = 0.0;
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
    sum += 0.5 * (corner(i + 1) - corner(i)).cross(corner(i + 2) - corner(i)).norm();
  }
  return sum;
}

/// Writes geoms into bodies, and the meshes that they show into assets, each once a scale.
class Visuals {
 public:
  Visuals(const RobotLook& look, XMLElement& assets) : look_(look), assets_(assets) {}

  void add(const RobotVisual& visual, XMLElement& body) {
    if (visual.kind != Kind::mesh) {
      add_geom(visual, visual.colour, body);
      return;
    }
    const std::vector<VisualMesh>& parts = look_.meshes.at(visual.mesh);
    for (std::size_t part = 0; part < parts.size(); ++part) {
      const std::string name = mesh_name(visual, part);
      if (name.empty()) continue;
      add_geom(visual, visual.colour ? visual.colour : parts[part].colour, body).SetAttribute("mesh", name.c_str());
    }
  }

 private:
  XMLElement& add_geom(const RobotVisual& visual, const std::optional<Eigen::Vector3d>& colour, XMLElement& body) {
    const Eigen::Vector3d p = visual.placement.translation(), size = visual.size.cwiseMax(kThinnest);
    const Eigen::Quaterniond q(visual.placement.linear());
    XMLElement& geom = *body.InsertNewChildElement("geom");
    geom.SetAttribute("class", "visual");
    switch (visual.kind) {
      case Kind::box: set_shape(geom, "box", {0.5 * size.x(), 0.5 * size.y(), 0.5 * size.z()}); break;
      case Kind::sphere: set_shape(geom, "sphere", {size.x()}); break;
      case Kind::cylinder: set_shape(geom, "cylinder", {size.x(), 0.5 * size.z()}); break;
      case Kind::capsule: set_shape(geom, "capsule", {size.x(), 0.5 * size.z()}); break;
      case Kind::mesh: geom.SetAttribute("type", "mesh"); break;
    }
    geom.SetAttribute("pos", numbers(p).c_str());
    geom.SetAttribute("quat", numbers(std::array{q.w(), q.x(), q.y(), q.z()}).c_str());
    geom.SetAttribute("rgba", (numbers(colour.value_or(kNoColour)) + " 1").c_str());
    return geom;
  }

  static void set_shape(XMLElement& geom, const char* type, const std::vector<double>& size) {
    geom.SetAttribute("type", type);
    geom.SetAttribute("size", numbers(size).c_str());
  }

  /// Of the asset, which is added the first time; "" for a part that is left out.
  std::string mesh_name(const RobotVisual& visual, std::size_t part) {
    const auto key = std::tuple(visual.mesh, part, numbers(visual.size));
    const auto [entry, is_new] = names_.try_emplace(key);
    const VisualMesh& mesh = look_.meshes.at(visual.mesh)[part];
    if (!is_new || area(mesh, visual.size) < kSmallestArea) return entry->second;
    entry->second = fmt::format("{} {}", std::filesystem::path(visual.mesh).stem().string(), names_.size());
    std::vector<float> vertices = mesh.positions;
    while (vertices.size() < 3 * kFewestVertices) vertices.insert(vertices.end(), vertices.end() - 3, vertices.end());
    XMLElement& asset = *assets_.InsertNewChildElement("mesh");
    asset.SetAttribute("name", entry->second.c_str());
    asset.SetAttribute("inertia", "shell");  // not used, but others need closed meshes
    asset.SetAttribute("scale", std::get<2>(key).c_str());
    asset.SetAttribute("vertex", numbers(vertices).c_str());
    asset.SetAttribute("face", fmt::format("{}", fmt::join(mesh.triangles, " ")).c_str());
    return entry->second;
  }

  const RobotLook& look_;
  XMLElement& assets_;
  std::map<std::tuple<std::string, std::size_t, std::string>, std::string> names_;
};

/// <default><default class="visual">: what all geoms of the look have in common. Also more light than MuJoCo's own.
void add_class_and_light(tinyxml2::XMLDocument& document, XMLElement& root) {
  XMLElement* const defaults = document.NewElement("default");
  root.InsertFirstChild(defaults);
  XMLElement* const visual = defaults->InsertNewChildElement("default");
  visual->SetAttribute("class", "visual");
  XMLElement* const geom = visual->InsertNewChildElement("geom");
  geom->SetAttribute("group", 2);
  for (const char* none : {"contype", "conaffinity", "mass"}) geom->SetAttribute(none, 0);
  XMLElement* const light = root.InsertNewChildElement("visual")->InsertNewChildElement("headlight");
  light->SetAttribute("ambient", "0.4 0.4 0.4");
  light->SetAttribute("diffuse", "0.6 0.6 0.6");
}

}  // namespace

std::string add_mujoco_visuals(const std::string& model, const RobotModel& robot, const RobotLook& look) {
  const auto document = parse_mjcf(model, robot.name());
  XMLElement* const root = document->RootElement();
  add_class_and_light(*document, *root);
  std::map<std::string, XMLElement*> bodies;
  collect_bodies(*root->FirstChildElement("worldbody"), bodies);
  XMLElement* assets = root->FirstChildElement("asset");
  if (!assets) root->InsertAfterChild(root->FirstChildElement("default"), assets = document->NewElement("asset"));
  const BodyTree tree = body_tree(robot);
  Visuals visuals(look, *assets);
  for (const RobotVisual& visual : look.visuals) visuals.add(visual, *bodies.at(tree.bodies[visual.body].name));
  return mjcf_text(*document);
}

}  // namespace prowl
