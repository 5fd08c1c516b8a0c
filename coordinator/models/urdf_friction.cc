#include "coordinator/models/urdf_friction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

namespace tcs {
namespace {

using tinyxml2::XMLElement;

// The value, as an attribute `value` or as text: both forms are in use.
std::optional<double> ValueOf(const XMLElement* element) {
  if (element == nullptr) return std::nullopt;
  double value = 0;
  const bool is_there = element->QueryDoubleAttribute("value", &value) == tinyxml2::XML_SUCCESS ||
                        element->QueryDoubleText(&value) == tinyxml2::XML_SUCCESS;
  if (!is_there || !std::isfinite(value) || value < 0) return std::nullopt;
  return value;
}

}  // namespace

std::map<std::string, double> FrictionOfLinks(const tinyxml2::XMLDocument& document) {
  std::map<std::string, double> friction;
  for (const XMLElement* e = document.RootElement()->FirstChildElement(); e != nullptr;
       e = e->NextSiblingElement()) {
    const std::string_view kind = e->Name();
    const char* link = nullptr;
    std::optional<double> value;
    if (kind == "gazebo") {
      link = e->Attribute("reference");
      value = ValueOf(e->FirstChildElement("mu1"));
      if (!value) value = ValueOf(e->FirstChildElement("mu"));
    } else if (kind == "link") {
      link = e->Attribute("name");
      const XMLElement* contact = e->FirstChildElement("contact");
      if (contact != nullptr) value = ValueOf(contact->FirstChildElement("lateral_friction"));
    }
    if (link != nullptr && value) friction[link] = *value;
  }
  return friction;
}

bool IsOnlyFriction(const XMLElement& element) {
  constexpr std::array<std::string_view, 5> kRead = {"mu", "mu1", "mu2", "lateral_friction",
                                                     "material"};
  for (const XMLElement* e = element.FirstChildElement(); e != nullptr;
       e = e->NextSiblingElement()) {
    if (std::ranges::find(kRead, e->Name()) == kRead.end()) return false;
  }
  return element.FirstChildElement() != nullptr;
}

}  // namespace tcs
