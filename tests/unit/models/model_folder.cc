#include "tests/unit/models/model_folder.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <variant>

namespace tcs {

namespace fs = std::filesystem;

ModelFolder::ModelFolder() {
  std::string name = (fs::temp_directory_path() / "tcs_models_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp failed");
  path_ = fs::canonical(name);
}

ModelFolder::~ModelFolder() { fs::remove_all(path_); }

std::string ModelFolder::Write(std::string_view name, std::string_view text) const {
  fs::create_directories(fs::path(Path(name)).parent_path());
  std::ofstream(Path(name), std::ios::binary) << text;
  return Path(name);
}

Loaded LoadFile(const std::string& path, const UrdfUse& use,
                const std::vector<std::string>& packages) {
  MeshLibrary meshes;
  Loaded loaded;
  UrdfRemarks remarks;
  auto result = LoadUrdf(path, use, PackagePath(packages), &meshes, &remarks);
  loaded.warnings = remarks.warnings;
  loaded.details = remarks.details;
  if (const auto* errors = std::get_if<std::vector<LoadError>>(&result)) {
    for (const LoadError& error : *errors) {
      EXPECT_EQ(error.message.find('\n'), std::string::npos) << error.message;
      loaded.mistakes.push_back(error.message);
    }
    loaded.mistake = loaded.mistakes.at(0);
  } else {
    loaded.model = std::get<LoadedUrdf>(std::move(result)).model;
  }
  return loaded;
}

Loaded LoadText(const ModelFolder& folder, std::string_view text, const UrdfUse& use) {
  Loaded loaded = LoadFile(folder.Write("robot.urdf", text), use);
  const std::string prefix = folder.Path("");
  const auto shorten = [&prefix](std::string* sentence) {
    for (std::size_t at; (at = sentence->find(prefix)) != std::string::npos;) {
      sentence->erase(at, prefix.size());
    }
  };
  shorten(&loaded.mistake);
  for (auto* sentences : {&loaded.mistakes, &loaded.warnings, &loaded.details}) {
    for (std::string& sentence : *sentences) shorten(&sentence);
  }
  return loaded;
}

const Link& LinkNamed(const RobotModel& model, std::string_view name) {
  for (const Link& link : model.links) {
    if (link.name == name) return link;
  }
  throw std::logic_error("no link " + std::string(name));
}

const Joint& JointNamed(const RobotModel& model, std::string_view name) {
  for (const Joint& joint : model.joints) {
    if (joint.name == name) return joint;
  }
  throw std::logic_error("no joint " + std::string(name));
}

std::string ZooPath(std::string_view name) { return TCS_MODEL_ZOO "/" + std::string(name); }

std::string TextOfZoo(std::string_view name) {
  std::ostringstream text;
  text << std::ifstream(ZooPath(name), std::ios::binary).rdbuf();
  return text.str();
}

}  // namespace tcs
