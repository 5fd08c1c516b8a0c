#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "coordinator/models/load_urdf.h"
#include "coordinator/os/visible.h"
#include "simbody_bridge/engines.h"
#include "simbody_bridge/model/model_check.h"
#include "tests/unit/fuzz/fuzz.h"
#include "tests/unit/fuzz/mutate.h"
#include "tests/unit/models/model_folder.h"

namespace tcs::fuzz {

namespace {

namespace fs = std::filesystem;

std::vector<std::string> ModelTokens() {
  std::string deep, entities = "<!DOCTYPE robot [<!ENTITY a \"aaaaaaaaaa\">";
  for (int i = 0; i < 5'000; ++i) deep += "<link name=\"l\">";
  for (char c = 'b'; c < 'k'; ++c) {
    entities += std::string("<!ENTITY ") + c + " \"";
    for (int i = 0; i < 8; ++i) entities += std::string("&") + static_cast<char>(c - 1) + ";";
    entities += "\">";
  }
  return {"<",
          ">",
          "/>",
          "\"",
          "'",
          "&",
          "&a;",
          "&#0;",
          "<!--",
          "-->",
          "nan",
          "inf",
          "-1",
          "0",
          "1e308",
          "1e-308",
          "1e999",
          "-0.5",
          "99999999999",
          "0x10",
          "1,5",
          std::string(1, '\0'),
          "\xff",
          "<link name=\"x\"/>",
          "<limit/>",
          "mimic",
          "floating",
          "planar",
          "continuous",
          "prismatic",
          "<mesh filename=\"/dev/zero\"/>",
          "package://",
          "package://../..",
          "<mesh filename=\"package://zoo_description/meshes/wedge.stl\" scale=\"0 1 1\"/>",
          "<parent link=\"x\"/>",
          "<child link=\"base_link\"/>",
          "<![CDATA[",
          "<?xml?>",
          "solid x\n",
          "facet normal 0 0 0\n",
          "v 0 0 0\n",
          "f 1 2 3\n",
          "f -1 9999999 0\n",
          deep,
          entities + "]>"};
}

// The zoo: robots, and the meshes that these are made of.
struct Input {
  std::string kind;  // the end of the file's name
  std::string text;
};
std::vector<Input> Corpus() {
  std::vector<Input> corpus;
  for (const auto& entry : fs::recursive_directory_iterator(TCS_MODEL_ZOO)) {
    if (!entry.is_regular_file()) continue;
    const std::string kind = entry.path().extension();
    if (kind == ".urdf" || kind == ".stl" || kind == ".obj" || kind == ".dae") {
      corpus.push_back({kind, TextOf(entry.path())});
    }
  }
  std::ranges::sort(corpus, {}, &Input::text);  // the folder has no order
  return corpus;
}

bool IsOneSentence(const std::string& sentence) {
  return !sentence.empty() && sentence.size() < 10'000 && sentence.find('\n') == std::string::npos;
}

// A tenth of a second of its motion on each engine, which may refuse it, too.
std::string Move(const RobotModel& model, bool* refused) {
  for (const EngineTraits& engine : kEngines) {
    if (!engine.has_models) continue;
    WorldSpec world;
    world.gravity_mps2 = {0, 0, -9.81};
    world.integrator.engine = engine.kind;
    world.models = {model};
    world.fixtures = {{.geometry = PlaneShape{}}};
    try {
      auto dynamics = MakeDynamics(world);
      const VirtualTime end = VirtualTime{} + VirtualDuration::Milliseconds(100);
      for (int link = 0; link < static_cast<int>(model.links.size()); ++link) {
        LinkState state;
        dynamics->ReadLinks(end, {&link, 1}, {&state, 1});
        if (!std::isfinite(state.pose.position_m[2])) return "a link is nowhere";
      }
    } catch (const DynamicsError& error) {
      *refused = true;
      if (!IsOneSentence(error.what())) return "an engine says: " + Visible(error.what());
    }
  }
  return {};
}

// `path` is what a refusal begins with.
std::string Load(const std::string& urdf, const std::string& damaged, bool* refused) {
  MeshLibrary meshes;
  UrdfRemarks remarks;
  const auto loaded = LoadUrdf(urdf, {}, PackagePath({TCS_MODEL_ZOO}), &meshes, &remarks);
  for (const std::string& warning : remarks.warnings) {
    if (!IsOneSentence(warning)) return "a warning is: " + Visible(warning);
  }
  const auto* errors = std::get_if<std::vector<LoadError>>(&loaded);
  *refused = errors != nullptr;
  if (errors != nullptr) {
    if (errors->empty()) return "a refusal says nothing";
    for (const auto& [message] : *errors) {
      const bool is_placed = message.starts_with(urdf + ":") || message.starts_with(damaged + ":");
      if (!is_placed || !IsOneSentence(message)) {
        return "a refusal does not say where: " + Visible(message);
      }
    }
    return {};
  }
  const RobotModel& model = std::get<LoadedUrdf>(loaded).model;
  // Where its joints start is not in the file.
  if (CheckModel(model).has_value()) return {};
  constexpr std::size_t kMostLinks = 60;
  return model.links.size() > kMostLinks ? "" : Move(model, refused);
}

}  // namespace

Tally FuzzModels(int count, std::uint64_t seed) {
  const ModelFolder folder;
  const std::vector<Input> corpus = Corpus();
  const std::vector<std::string> tokens = ModelTokens();
  std::vector<std::string> texts;
  for (const Input& input : corpus) texts.push_back(input.text);
  Tally tally;
  for (int number = 0; number < count; ++number) {
    Mutator mutator(seed * 1'000'003 + static_cast<std::uint64_t>(number), tokens);
    const Input& input = corpus[mutator.Below(corpus.size())];
    const std::string text = mutator.Damage(input.text, texts);
    const std::string damaged = folder.Write("damaged" + input.kind, text);
    const std::string urdf =
        input.kind == ".urdf"
            ? damaged
            : folder.Write("robot.urdf",
                           "<robot name=\"r\"><link name=\"l\"><inertial><mass value=\"1\"/>"
                           "<inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/>"
                           "</inertial><collision><geometry><mesh filename=\"damaged" +
                               input.kind + "\"/></geometry></collision></link></robot>");
    const auto wrong = tally.Count([&](bool* refused) { return Load(urdf, damaged, refused); });
    if (wrong.has_value()) SayWrong("models", number, *wrong, text);
  }
  return tally;
}

}  // namespace tcs::fuzz
