#include "coordinator/snapshot/world_snapshot.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <span>
#include <variant>
#include <vector>

#include "coordinator/snapshot/recorded_state.h"
#include "coordinator/text/csv.h"
#include "coordinator/text/yaml_text.h"

namespace tcs::snapshot {
namespace {

using Json = nlohmann::json;
using Numbers = std::span<const std::string>;

struct Mistake {
  std::string what;
};

std::string List(Numbers numbers) {
  return fmt::format("[{}]", fmt::join(numbers.begin(), numbers.end(), ", "));
}

std::string PoseText(Numbers state) {
  return fmt::format("position: {}, orientation: {}", List(state.subspan(0, 3)),
                     List(state.subspan(3, 4)));
}

std::string VelocitiesText(Numbers state) {
  return fmt::format("linear_velocity: {}, angular_velocity: {}", List(state.subspan(7, 3)),
                     List(state.subspan(10, 3)));
}

class Writer {
 public:
  Writer(const RecordedState& state, const Json& scene) : state_(state), scene_(scene) {}

  std::string Text() {
    std::string bodies, models;
    for (const Json& body : scene_.at("bodies")) {
      const std::string name = body.at("name");
      const Numbers state = StateOf(name);
      bodies +=
          fmt::format("  {}: {{{}, {}}}\n", YamlText(name), PoseText(state), VelocitiesText(state));
    }
    for (const Json& model : scene_.at("models")) models += ModelText(model);
    return (bodies.empty() ? "" : "bodies:\n" + bodies) +
           (models.empty() ? "" : "models:\n" + models);
  }

 private:
  Numbers StateOf(const std::string& name) const {
    const auto found = state_.bodies.find(name);
    if (found == state_.bodies.end()) throw Mistake{"bodies.csv has no line of '" + name + "'"};
    return found->second;
  }

  std::string ModelText(const Json& model) const {
    const std::string name = model.at("name");
    const bool is_fixed = model.at("fixed_base");
    const Json& links = model.at("links");
    const Numbers root = StateOf(links.at(model.at("root").get<std::size_t>()).at("name"));
    std::vector<std::string> parts;
    if (!is_fixed) {
      const bool is_robot = model.value("urdf", false);
      parts.push_back(is_robot ? "at: {" + PoseText(root) + "}" : PoseText(root));
      parts.push_back(VelocitiesText(root));
    }
    if (const std::string joints = JointsText(name, links); !joints.empty()) {
      parts.push_back("joints: {" + joints + "}");
    }
    if (parts.empty()) return {};
    return fmt::format("  {}: {{{}}}\n", YamlText(name), fmt::join(parts, ", "));
  }

  std::string JointsText(const std::string& model, const Json& links) const {
    std::string text;
    for (const Json& link : links) {
      const std::string kind = link.value("kind", "fixed");
      if (kind == "fixed" || link.value("mimics", false)) continue;
      const std::string joint = link.at("joint");
      const auto found = state_.joints.find(model + "/" + joint);
      if (found == state_.joints.end()) {
        throw Mistake{
            fmt::format("how the {} joint '{}' of {} stood is not in joints.csv, so that no "
                        "run can begin from there",
                        kind, joint, model)};
      }
      text +=
          fmt::format("{}{}: {}", text.empty() ? "" : ", ", YamlText(joint), List(found->second));
    }
    return text;
  }

  const RecordedState& state_;
  const Json& scene_;
};

}  // namespace

LoadResult<std::string> WorldAt(const std::string& folder, std::optional<std::int64_t> at_ns) {
  const auto read = ReadState(folder, at_ns);
  if (const auto* error = std::get_if<LoadError>(&read)) return *error;
  const auto& state = std::get<RecordedState>(read);
  const std::string scene_file = folder + "/scene.json";
  const auto text = ReadFile(scene_file);
  const Json scene = text ? Json::parse(*text, nullptr, false) : Json(Json::value_t::discarded);
  if (scene.is_discarded()) {
    return LoadError{scene_file + " cannot be read; give the folder of a run of this tcsim"};
  }
  try {
    return fmt::format(
        "# The world at {}: `tcsim run SCENARIO --overlay` this file begins from there.\n{}",
        SecondsText(state.at_ns), Writer(state, scene).Text());
  } catch (const Mistake& mistake) {
    return LoadError{folder + ": " + mistake.what};
  } catch (const Json::exception&) {
    return LoadError{scene_file +
                     " was not written by this version of tcsim; run the scenario again"};
  }
}

}  // namespace tcs::snapshot
