// The documents of a YAML text.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace tcs {

struct YamlDocuments {
  YAML::Node first;
  int count = 0;        // 2: or more
  int second_line = 0;  // of the text, from 1
};

// Throws YAML::Exception. Unlike YAML::LoadAll it comes to an end also where something follows a
// document that is none.
YamlDocuments LoadDocuments(const std::string& text);

}  // namespace tcs
