#include "coordinator/world/scene_text.h"

#include <map>
#include <nlohmann/json.hpp>
#include <utility>
#include <variant>
#include <vector>

#include "coordinator/models/model_mistake.h"
#include "coordinator/models/package_path.h"
#include "coordinator/models/urdf_visuals.h"
#include "coordinator/world/link_lines.h"
#include "simbody_bridge/model/joint_kinds.h"

namespace tcs {
namespace {

using Json = nlohmann::ordered_json;

Json PoseJson(const Pose& pose) {
  const auto& p = pose.position_m;
  const auto& q = pose.orientation_xyzw;
  return {p[0], p[1], p[2], q[0], q[1], q[2], q[3]};
}

class SceneWriter {
 public:
  explicit SceneWriter(const Scenario& scenario)
      : scenario_(scenario), world_(*scenario.world), link_names_(NamesOfLinks(world_)) {}

  std::string Text() {
    Json scene{{"version", 1}, {"gravity_mps2", world_.gravity_mps2}};
    scene["region_m"] = world_.has_region ? Json(world_.region.half_extent_m) : Json();
    Json& bodies = scene["bodies"] = Json::array();
    for (const BodySpec& body : world_.bodies) {
      bodies.push_back(
          {{"name", body.name}, {"mass_kg", body.mass_kg}, {"inertia_kgm2", body.inertia_kgm2}});
    }
    Json& fixtures = scene["fixtures"] = Json::array();
    for (const Shape& shape : world_.fixtures) fixtures.push_back(ShapeJson(shape));
    Json& models = scene["models"] = Json::array();
    std::size_t first_link = 0;
    for (const RobotModel& model : world_.models) {
      models.push_back(ModelJson(model, first_link));
      first_link += model.links.size();
    }
    scene["sensors"] = Sensors();
    scene["meshes"] = std::move(meshes_);
    return scene.dump(-1, ' ', true, Json::error_handler_t::replace) + "\n";
  }

 private:
  Json ModelJson(const RobotModel& model, std::size_t first_link) {
    std::vector<const Joint*> above(model.links.size());
    for (const Joint& joint : model.joints) above[static_cast<std::size_t>(joint.child)] = &joint;
    Json links = Json::array();
    const auto file = scenario_.urdf_files.find(model.name);
    const std::string urdf = file == scenario_.urdf_files.end() ? "" : file->second;
    const auto made = scenario_.urdf_expanded.find(model.name);
    auto visuals_of =
        urdf.empty() ? std::map<std::string, std::vector<Visual>>{}
                     : ReadVisuals(urdf, made == scenario_.urdf_expanded.end() ? "" : made->second);
    const auto packages = scenario_.urdf_packages.find(model.name);
    const PackagePath files(packages == scenario_.urdf_packages.end() ? std::vector<std::string>{}
                                                                      : packages->second);
    for (std::size_t i = 0; i < model.links.size(); ++i) {
      const Link& link = model.links[i];
      Json entry{{"name", link_names_[first_link + i]}};
      if (const Joint* joint = above[i]) {
        entry["parent"] = joint->parent;
        entry["joint"] = joint->name;
        entry["kind"] = NameOf(joint->kind);
        if (joint->mimic) entry["mimics"] = true;
        entry["pose"] = PoseJson(joint->origin);
      }
      Json& shapes = entry["shapes"] = Json::array();
      for (const Shape& shape : link.shapes) shapes.push_back(ShapeJson(shape));
      Json& visuals = entry["visuals"] = Json::array();
      for (const Visual& visual : visuals_of[link.name]) {
        visuals.push_back(VisualJson(visual));
        const auto* mesh = std::get_if<MeshFile>(&visual.geometry);
        if (mesh == nullptr) continue;
        const std::string path = PathOf(*mesh, files, urdf);
        if (!path.empty()) visuals.back()["path"] = path;
      }
      links.push_back(std::move(entry));
    }
    return {{"name", model.name},
            {"root", model.root},
            {"fixed_base", model.has_fixed_base},
            {"urdf", !urdf.empty()},
            {"links", std::move(links)}};
  }

  Json ShapeJson(const Shape& shape) {
    Json json = std::visit([this](const auto& each) { return GeometryJson(each); }, shape.geometry);
    if (!shape.name.empty()) json["name"] = shape.name;
    json["pose"] = PoseJson(shape.pose);
    return json;
  }

  // The path of the file, for programs that draw it; empty: not known.
  static std::string PathOf(const MeshFile& mesh, const PackagePath& files,
                            const std::string& urdf) {
    try {
      return files.Find(mesh.name, urdf);
    } catch (const ModelMistake&) {
      return {};
    }
  }

  Json VisualJson(const Visual& visual) {
    Json json =
        std::visit([this](const auto& each) { return GeometryJson(each); }, visual.geometry);
    json["pose"] = PoseJson(visual.pose);
    if (visual.colour_rgba) json["colour"] = *visual.colour_rgba;
    return json;
  }

  Json GeometryJson(const BoxShape& box) { return {{"kind", "box"}, {"size", box.size_m}}; }
  Json GeometryJson(const SphereShape& sphere) {
    return {{"kind", "sphere"}, {"radius", sphere.radius_m}};
  }
  Json GeometryJson(const CylinderShape& cylinder) {
    return {{"kind", "cylinder"}, {"radius", cylinder.radius_m}, {"length", cylinder.length_m}};
  }
  Json GeometryJson(const CapsuleShape& capsule) {
    return {{"kind", "capsule"}, {"radius", capsule.radius_m}, {"length", capsule.length_m}};
  }
  Json GeometryJson(const PlaneShape&) { return {{"kind", "plane"}}; }
  Json GeometryJson(const MeshFile& mesh) {
    return {{"kind", "mesh_file"}, {"name", mesh.name}, {"scale", mesh.scale}};
  }
  Json GeometryJson(const MeshShape& mesh) {
    const auto [place, is_new] = mesh_numbers_.try_emplace(mesh.mesh.get(), meshes_.size());
    if (is_new) {
      meshes_.push_back({{"name", mesh.mesh->name},
                         {"vertices", mesh.mesh->vertices_m},
                         {"triangles", mesh.mesh->triangles}});
    }
    return {{"kind", "mesh"}, {"mesh", place->second}};
  }

  // The sensors whose rays lie in a plane.
  Json Sensors() const {
    Json sensors = Json::array();
    for (const SensorChannelSpec& channel : scenario_.sensors) {
      const auto* lidar =
          channel.instrument ? std::get_if<LidarSpec>(&*channel.instrument) : nullptr;
      if (lidar == nullptr) continue;
      sensors.push_back({{"channel", channel.name},
                         {"kind", "lidar"},
                         {"link", link_names_[static_cast<std::size_t>(lidar->mount.link)]},
                         {"pose", PoseJson(lidar->mount.at)},
                         {"rays", lidar->rays},
                         {"first_rad", lidar->first_rad},
                         {"last_rad", lidar->last_rad},
                         {"least_m", lidar->reach.least_m},
                         {"most_m", lidar->reach.most_m}});
    }
    return sensors;
  }

  const Scenario& scenario_;
  const WorldSpec& world_;
  const std::vector<std::string> link_names_;
  std::map<const Mesh*, std::size_t> mesh_numbers_;
  Json meshes_ = Json::array();
};

}  // namespace

std::string SceneText(const Scenario& scenario) {
  return scenario.world ? SceneWriter(scenario).Text() : std::string();
}

}  // namespace tcs
