#include "coordinator/models/urdf_visuals.h"

#include <tinyxml2.h>

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "coordinator/models/model_mistake.h"
#include "coordinator/models/urdf_xml.h"

namespace tcs {
namespace {

using tinyxml2::XMLElement;

template <std::size_t kCount>
std::optional<std::array<double, kCount>> NumbersOf(const XMLElement* element, const char* name) {
  const char* text = element == nullptr ? nullptr : element->Attribute(name);
  if (text == nullptr) return {};
  std::array<double, kCount> numbers{};
  for (double& number : numbers) {
    char* end = nullptr;
    number = std::strtod(text, &end);
    if (end == text || !std::isfinite(number)) return {};
    text = end;
  }
  return numbers;
}

// The numbers of an attribute, if all are above 0.
template <std::size_t kCount>
std::optional<std::array<double, kCount>> SizesOf(const XMLElement* element, const char* name) {
  const auto sizes = NumbersOf<kCount>(element, name);
  if (!sizes) return {};
  for (const double size : *sizes) {
    if (!(size > 0)) return {};
  }
  return sizes;
}

Pose PoseOf(const XMLElement* origin) {
  Pose pose;
  if (const auto xyz = NumbersOf<3>(origin, "xyz")) pose.position_m = *xyz;
  if (const auto rpy = NumbersOf<3>(origin, "rpy")) {
    pose.orientation_xyzw = FromRollPitchYaw((*rpy)[0], (*rpy)[1], (*rpy)[2]);
  }
  return pose;
}

std::optional<decltype(Visual::geometry)> GeometryOf(const XMLElement* geometry) {
  const XMLElement* shape = geometry == nullptr ? nullptr : geometry->FirstChildElement();
  if (shape == nullptr) return {};
  const std::string_view kind = shape->Name();
  if (kind == "box") {
    if (const auto size = SizesOf<3>(shape, "size")) return BoxShape{*size};
  } else if (kind == "sphere") {
    if (const auto radius = SizesOf<1>(shape, "radius")) return SphereShape{(*radius)[0]};
  } else if (kind == "cylinder") {
    const auto radius = SizesOf<1>(shape, "radius"), length = SizesOf<1>(shape, "length");
    if (radius && length) return CylinderShape{(*radius)[0], (*length)[0]};
  } else if (kind == "mesh") {
    if (const char* name = shape->Attribute("filename")) {
      return MeshFile{name, NumbersOf<3>(shape, "scale").value_or(std::array<double, 3>{1, 1, 1})};
    }
  }
  return {};
}

std::optional<std::array<double, 4>> ColourIn(const XMLElement* material) {
  return NumbersOf<4>(material == nullptr ? nullptr : material->FirstChildElement("color"), "rgba");
}

// The visual's own colour, or that of the robot's material of the same name.
std::optional<std::array<double, 4>> ColourOf(const XMLElement& visual) {
  const XMLElement* material = visual.FirstChildElement("material");
  if (const auto own = ColourIn(material)) return own;
  const char* name = material == nullptr ? nullptr : material->Attribute("name");
  if (name == nullptr) return {};
  const XMLElement* robot = visual.GetDocument()->RootElement();
  for (const XMLElement* each = robot->FirstChildElement("material"); each != nullptr;
       each = each->NextSiblingElement("material")) {
    const char* its_name = each->Attribute("name");
    if (its_name != nullptr && std::string_view(its_name) == name) return ColourIn(each);
  }
  return {};
}

std::vector<Visual> VisualsOf(const XMLElement& link) {
  std::vector<Visual> visuals;
  for (const XMLElement* each = link.FirstChildElement("visual"); each != nullptr;
       each = each->NextSiblingElement("visual")) {
    auto geometry = GeometryOf(each->FirstChildElement("geometry"));
    if (!geometry) continue;
    visuals.push_back(
        {std::move(*geometry), PoseOf(each->FirstChildElement("origin")), ColourOf(*each)});
  }
  return visuals;
}

}  // namespace

std::map<std::string, std::vector<Visual>> ReadVisuals(const std::string& path,
                                                       const std::string& expanded) {
  std::map<std::string, std::vector<Visual>> visuals;
  try {
    const auto document = expanded.empty() ? ReadUrdfXml(path) : ParseUrdf(path, expanded);
    for (const XMLElement* link = document->RootElement()->FirstChildElement("link");
         link != nullptr; link = link->NextSiblingElement("link")) {
      if (const char* name = link->Attribute("name")) visuals[name] = VisualsOf(*link);
    }
  } catch (const ModelMistake&) {
    // The file is gone, or has changed, since the robot was read.
  }
  return visuals;
}

}  // namespace tcs
