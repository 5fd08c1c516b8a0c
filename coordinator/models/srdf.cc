#include "coordinator/models/srdf.h"

#include <tinyxml2.h>

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "coordinator/models/file_text.h"
#include "coordinator/models/model_mistake.h"
#include "coordinator/models/urdf_xml.h"

namespace tcs {

std::vector<std::pair<std::string, std::string>> DisabledCollisions(const std::string& path) {
  constexpr std::size_t kMostBytes = 4 << 20;
  const std::string text = TextOf(path, kMostBytes, "an SRDF file");
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    FailAt(path, std::max(1, document.ErrorLineNum()), "this is not valid XML; correct it");
  }
  const tinyxml2::XMLElement* root = document.RootElement();
  if (root == nullptr || std::string_view(root->Name()) != "robot") {
    FailAt(path, 1, "there is no <robot> in this file; give an SRDF file");
  }
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const auto* e = root->FirstChildElement("disable_collisions"); e != nullptr;
       e = e->NextSiblingElement("disable_collisions")) {
    const char *a = e->Attribute("link1"), *b = e->Attribute("link2");
    if (a == nullptr || b == nullptr) {
      FailAt(path, e->GetLineNum(),
             "<disable_collisions> names no two links; write link1=\"…\" link2=\"…\"");
    }
    pairs.emplace_back(a, b);
  }
  return pairs;
}

}  // namespace tcs
