#include "prowl/model/urdf/urdf_shapes.hpp"

#include <fmt/format.h>

#include <sstream>
#include <string_view>

#include "prowl/text/shown_text.hpp"

namespace prowl {

using tinyxml2::XMLElement;

namespace {

void check_size(const UrdfPlace& place, const XMLElement& shape, const char* name) {
  const double size = urdf_number(place, shape, name);
  if (size < 0.0)
    place.refuse(shape, fmt::format("<{} {}=\"{}\">: expected a number >= 0 [m]", shape.Name(), name, size));
}

void check_box(const UrdfPlace& place, const XMLElement& box) {
  urdf_text(place, box, "size");
  check_urdf_vector(place, &box, "size");
  if (std::string_view(box.Attribute("size")).find('-') == std::string_view::npos) return;
  std::istringstream numbers(box.Attribute("size"));
  for (double size = 0.0; numbers >> size;) {
    if (size < 0.0)
      place.refuse(box, fmt::format("<box size=\"{}\">: expected numbers >= 0 [m]", shown(box.Attribute("size"))));
  }
}

void check_geometry(const UrdfPlace& place, const XMLElement& shape) {
  const std::string_view kind = shape.Name();
  if (kind == "box") check_box(place, shape);
  if (kind == "sphere" || kind == "cylinder" || kind == "capsule") check_size(place, shape, "radius");
  if (kind == "cylinder" || kind == "capsule") check_size(place, shape, "length");
  if (kind == "mesh") {
    urdf_text(place, shape, "filename");
    check_urdf_vector(place, &shape, "scale");  // negative ones mirror
  }
}

}  // namespace

void check_shapes(const UrdfPlace& place, const XMLElement& link) {
  for (const char* use : {"visual", "collision"}) {
    for (const XMLElement* e = link.FirstChildElement(use); e != nullptr; e = e->NextSiblingElement(use)) {
      check_urdf_origin(place, *e);
      const XMLElement* geometry = e->FirstChildElement("geometry");
      if (geometry != nullptr && geometry->FirstChildElement() != nullptr)
        check_geometry(place, *geometry->FirstChildElement());
      const XMLElement* material = e->FirstChildElement("material");
      if (material != nullptr) check_urdf_vector(place, material->FirstChildElement("color"), "rgba", 4);
    }
  }
}

}  // namespace prowl
