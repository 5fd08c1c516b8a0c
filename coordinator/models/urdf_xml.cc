#include "coordinator/models/urdf_xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "coordinator/errors/visible.h"
#include "coordinator/models/file_text.h"
#include "coordinator/models/model_mistake.h"

namespace tcs {
namespace {

using tinyxml2::XMLElement;
using tinyxml2::XMLNode;

constexpr std::size_t kMostUrdfBytes = 4 << 20;

const char* WhatIsWrong(tinyxml2::XMLError error) {
  switch (error) {
    case tinyxml2::XML_ERROR_PARSING:
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      return "an element begins here that is not closed, or is closed under another name";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      return "an attribute here is given twice, or not as name=\"value\"";
    case tinyxml2::XML_ERROR_PARSING_ELEMENT:
      return "an element here is not written as <name …> or <name …/>";
    case tinyxml2::XML_ERROR_PARSING_COMMENT:
      return "a comment begins here that has no end";
    case tinyxml2::XML_ERROR_PARSING_CDATA:
    case tinyxml2::XML_ERROR_PARSING_TEXT:
    case tinyxml2::XML_ERROR_PARSING_DECLARATION:
    case tinyxml2::XML_ERROR_PARSING_UNKNOWN:
      return "something begins here that has no end";
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
      return "elements are in one another more than a hundred deep";
    case tinyxml2::XML_ERROR_EMPTY_DOCUMENT:
      return "there is no element in it";
    default:
      return "it cannot be read any further from here";
  }
}

// The element after `element` in the order of the file.
const XMLElement* Next(const XMLElement* element) {
  if (const XMLElement* child = element->FirstChildElement()) return child;
  while (element != nullptr && element->NextSiblingElement() == nullptr) {
    const XMLNode* parent = element->Parent();
    element = parent == nullptr ? nullptr : parent->ToElement();
  }
  return element == nullptr ? nullptr : element->NextSiblingElement();
}

bool IsXacro(std::string_view value) {
  return value.find("${") != std::string_view::npos || value.find("$(") != std::string_view::npos;
}

// The first line on which something is left that xacro would have replaced; 0: none.
int LineOfXacro(const XMLElement* root) {
  for (const XMLElement* element = root; element != nullptr; element = Next(element)) {
    if (std::string_view(element->Name()).starts_with("xacro:")) return element->GetLineNum();
    for (const auto* a = element->FirstAttribute(); a != nullptr; a = a->Next()) {
      if (IsXacro(a->Value())) return a->GetLineNum();
    }
  }
  return 0;
}

[[noreturn]] void FailOnXacro(const std::string& path, int line) {
  std::filesystem::path expanded = path;
  expanded.replace_extension(expanded.extension() == ".xacro" ? "" : ".expanded.urdf");
  if (expanded.extension().empty()) expanded += ".urdf";
  FailAt(path, line,
         fmt::format(
             "xacro is not expanded here, for there is no program `xacro` in PATH; install it, or "
             "call `xacro {} > {}` where it is, and name that file",
             path, expanded.string()));
}

void CheckRoot(const std::string& path, const XMLElement* root) {
  const std::string_view name = root->Name();
  if (name == "robot") return;
  struct Other {
    std::string_view element, what, then;
  };
  constexpr std::array<Other, 4> kOthers = {{
      {"sdf", "Gazebo's SDF",
       "give the URDF that it was made of, or convert it, as with sdf2urdf.py of pysdf"},
      {"mujoco", "MuJoCo's MJCF",
       "give the URDF that it was made of, or convert it, as with mjcf_urdf_simple_converter of "
       "PyPI"},
      {"COLLADA", "a COLLADA mesh", "give the robot as URDF, which names its meshes"},
      {"launch", "a launch file", "give the URDF that it loads"},
  }};
  for (const auto& [element, what, then] : kOthers) {
    if (name != element) continue;
    FailAt(path, root->GetLineNum(), fmt::format("this is {}; {}", what, then));
  }
  FailAt(path, root->GetLineNum(),
         "the first element is " + Quoted(name) + "; a URDF file has one <robot>");
}

}  // namespace

std::unique_ptr<tinyxml2::XMLDocument> ReadUrdfXml(const std::string& path) {
  return ParseUrdf(path, TextOf(path, kMostUrdfBytes, "a URDF file"));
}

bool IsXacroFile(const std::string& path) {
  try {
    const std::string text = TextOf(path, kMostUrdfBytes, "a URDF file");
    tinyxml2::XMLDocument document;
    return document.Parse(text.data(), text.size()) == tinyxml2::XML_SUCCESS &&
           document.RootElement() != nullptr && LineOfXacro(document.RootElement()) > 0;
  } catch (const ModelMistake&) {
    return false;
  }
}

std::unique_ptr<tinyxml2::XMLDocument> ParseUrdf(const std::string& path,
                                                 const std::string& whole) {
  std::string text = whole;
  // Some files have been saved with the NUL at the end of a string.
  while (text.ends_with('\0')) text.pop_back();
  if (text.find('\0') != std::string::npos) {
    throw ModelMistake{path + ": holds NUL bytes, so it is no text in UTF-8; save it as that"};
  }
  auto document = std::make_unique<tinyxml2::XMLDocument>();
  if (document->Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    FailAt(path, std::max(1, document->ErrorLineNum()),
           fmt::format("this is not valid XML: {}; correct it", WhatIsWrong(document->ErrorID())));
  }
  for (const XMLNode* node = document->FirstChild(); node != nullptr; node = node->NextSibling()) {
    // <!DOCTYPE … [ … ]>: entities that stand for others would make any size of a few lines. A
    // declaration without brackets defines none.
    if (node->ToUnknown() == nullptr) continue;
    if (std::string_view(node->Value()).find('[') == std::string_view::npos) continue;
    FailAt(path, node->GetLineNum(),
           "a document type is declared here, whose entities are not expanded; remove it and write "
           "out what they stand for");
  }
  const XMLElement* root = document->RootElement();
  if (root == nullptr) FailAt(path, 1, "there is no <robot> in this file; give a URDF file");
  CheckRoot(path, root);
  if (const XMLElement* second = root->NextSiblingElement()) {
    FailAt(path, second->GetLineNum(),
           "a second element begins here, beside <robot>; keep one robot to a file");
  }
  if (const int line = LineOfXacro(root); line > 0) FailOnXacro(path, line);
  return document;
}

void FailAt(const std::string& path, int line, std::string_view sentence) {
  throw ModelMistake{fmt::format("{}:{}: {}", path, line, sentence)};
}

std::string Quoted(std::string_view text) {
  constexpr std::size_t kMost = 80;
  return "'" + Visible(text.substr(0, kMost)) + (text.size() > kMost ? "…'" : "'");
}

}  // namespace tcs
