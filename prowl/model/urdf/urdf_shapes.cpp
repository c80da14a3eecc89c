#include "prowl/model/urdf/urdf_shapes.hpp"

#include <fmt/format.h>

#include <sstream>
#include <string_view>

#include "prowl/text/shown_text.hpp"

namespace prowl {

using tinyxml2::XMLElement;

namespace {

void check_size(const UrdfLocation& location, const XMLElement& shape, const char* name) {
  const double size = urdf_number(location, shape, name);
  if (size < 0.0)
    location.refuse(shape, fmt::format("<{} {}=\"{}\">: expected a number >= 0 [m]", shape.Name(), name, size));
}

void check_box(const UrdfLocation& location, const XMLElement& box) {
  urdf_text(location, box, "size");
  check_urdf_vector(location, &box, "size");
  if (std::string_view(box.Attribute("size")).find('-') == std::string_view::npos) return;
  std::istringstream numbers(box.Attribute("size"));
  for (double size = 0.0; numbers >> size;) {
    if (size < 0.0)
      location.refuse(box, fmt::format("<box size=\"{}\">: expected numbers >= 0 [m]", shown(box.Attribute("size"))));
  }
}

void check_geometry(const UrdfLocation& location, const XMLElement& shape) {
  const std::string_view kind = shape.Name();
  if (kind == "box") check_box(location, shape);
  if (kind == "sphere" || kind == "cylinder" || kind == "capsule") check_size(location, shape, "radius");
  if (kind == "cylinder" || kind == "capsule") check_size(location, shape, "length");
  if (kind == "mesh") {
    urdf_text(location, shape, "filename");
    check_urdf_vector(location, &shape, "scale");  // negative ones mirror
  }
}

}  // namespace

void check_shapes(const UrdfLocation& location, const XMLElement& link) {
  for (const char* use : {"visual", "collision"}) {
    for (const XMLElement* e = link.FirstChildElement(use); e != nullptr; e = e->NextSiblingElement(use)) {
      check_urdf_origin(location, *e);
      const XMLElement* geometry = e->FirstChildElement("geometry");
      if (geometry != nullptr && geometry->FirstChildElement() != nullptr)
        check_geometry(location, *geometry->FirstChildElement());
      const XMLElement* material = e->FirstChildElement("material");
      if (material != nullptr) check_urdf_vector(location, material->FirstChildElement("color"), "rgba", 4);
    }
  }
}

}  // namespace prowl
