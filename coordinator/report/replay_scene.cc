#include "coordinator/report/replay_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "coordinator/report/looks.h"
#include "coordinator/text/csv.h"
#include "simbody_bridge/model/pose.h"

namespace tcs::report {
namespace {

using Json = nlohmann::ordered_json;

Pose PoseFrom(const Json& json) {
  const auto n = json.get<std::array<double, 7>>();
  return {{n[0], n[1], n[2]}, Normalised({n[3], n[4], n[5], n[6]})};
}

Json JsonOf(const Pose& pose) {
  const auto& p = pose.position_m;
  const auto& q = pose.orientation_xyzw;
  return {p[0], p[1], p[2], q[0], q[1], q[2], q[3]};
}

// A body has no shape: it is shown as a box of even density with its mass and its moments.
Json BoxLike(const Json& body) {
  const auto mass = body.at("mass_kg").get<double>();
  const auto i = body.at("inertia_kgm2").get<std::array<double, 3>>();
  std::array<double, 3> size{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double others = i[(axis + 1) % 3] + i[(axis + 2) % 3] - i[axis];
    size[axis] = std::sqrt(std::max(0.0, 6 * others / mass));
  }
  return {{"kind", "body"}, {"size", size}, {"pose", JsonOf({})}};
}

class SceneReader {
 public:
  SceneReader(Json scene, MeshLooks looks) : scene_(std::move(scene)) {
    if (looks == MeshLooks::kRead) looks_.emplace(CountMeshFiles());
  }

  ReplayScene Read() {
    meshes_ = scene_.at("meshes");
    for (const Json& body : scene_.at("bodies")) {
      const std::size_t track = AddTrack(body.at("name"));
      shapes_[track].push_back(BoxLike(body));
      found_.robots.push_back({body.at("name"), track, {track}, {}});
    }
    for (const Json& model : scene_.at("models")) AddModel(model);
    Json tracks = Json::array();
    for (std::size_t i = 0; i < found_.tracks.size(); ++i) tracks.push_back(shapes_[i]);
    AddSensors();
    found_.json = {{"region", scene_.at("region_m")},
                   {"fixtures", scene_.at("fixtures")},
                   {"meshes", std::move(meshes_)},
                   {"sensors", std::move(sensors_)},
                   {"tracks", std::move(tracks)}};
    return std::move(found_);
  }

 private:
  struct Place {
    std::size_t track = 0;
    Pose pose;  // in the track's frame
  };

  std::size_t AddTrack(const std::string& name) {
    found_.tracks.push_back(name);
    shapes_.push_back(Json::array());
    return found_.tracks.size() - 1;
  }

  void AddModel(const Json& model) {
    const Json& links = model.at("links");
    std::vector<bool> is_placed(links.size());
    std::vector<Place> places(links.size());
    ReplayScene::Robot robot{model.at("name"), 0, {}, {}};
    // A parent may stand after its child. Each round places at least one link, or the file is no
    // tree.
    for (std::size_t left = links.size(), before = left + 1; left > 0 && left < before;) {
      before = left;
      for (std::size_t i = 0; i < links.size(); ++i) {
        if (is_placed[i]) continue;
        const Json& link = links[i];
        const bool has_parent = link.contains("parent");
        const auto parent = has_parent ? link.at("parent").get<std::size_t>() : 0;
        if (has_parent && !is_placed.at(parent)) continue;
        if (has_parent && link.at("kind") == "fixed") {
          places[i] = {places[parent].track, Times(places[parent].pose, PoseFrom(link.at("pose")))};
        } else {
          places[i] = {AddTrack(link.at("name")), {}};
          robot.tracks.push_back(places[i].track);
        }
        is_placed[i] = true;
        --left;
        NoteJoint(link, &robot);
        AddShapes(link, places[i]);
        places_[link.at("name")] = places[i];
      }
    }
    if (robot.tracks.empty()) return;
    robot.root = robot.tracks.front();
    const bool stands = model.at("fixed_base").get<bool>();
    for (const Json& link : links) {
      const std::string name = link.at("name");
      const auto place = places_.find(name);
      if (place == places_.end() || (stands && place->second.track == robot.root)) continue;
      found_.moving.insert(name);
    }
    found_.robots.push_back(std::move(robot));
  }

  static void NoteJoint(const Json& link, ReplayScene::Robot* robot) {
    if (!link.contains("joint")) return;
    const std::string name = robot->name + "/" + link.at("joint").get<std::string>();
    robot->joint_units[name] = link.at("kind") == "prismatic" ? "m" : "rad";
  }

  std::size_t CountMeshFiles() const {
    std::set<std::string> files;
    for (const Json& model : scene_.at("models")) {
      for (const Json& link : model.at("links")) {
        for (const Json& visual : link.at("visuals")) {
          if (visual.contains("path")) files.insert(visual.at("path").get<std::string>());
        }
      }
    }
    return files.size();
  }

  // Makes a mesh of the page of a visual whose mesh is in a file. False if the mesh is not to be
  // had.
  bool ReadMesh(Json* visual) {
    if (!looks_ || !visual->contains("path")) return false;
    const auto scale = visual->at("scale").get<std::array<double, 3>>();
    const auto number = looks_->Take(visual->at("path"), scale, &meshes_);
    if (!number) return false;
    (*visual)["kind"] = "mesh";
    (*visual)["mesh"] = *number;
    const auto own = looks_->ColourOf(*number);
    if (own && !visual->contains("colour")) {
      (*visual)["colour"] = {(*own)[0], (*own)[1], (*own)[2], 1.0};
    }
    for (const char* key : {"name", "path", "scale"}) visual->erase(key);
    return true;
  }

  // Adds the looks of the link, or its collision shapes where nothing is said of its looks. Shapes
  // in the stead of a mesh that is not here have the mesh's colour.
  void AddShapes(const Json& link, const Place& place) {
    Json visuals = link.at("visuals");
    bool is_drawn = !visuals.empty();
    Json colour;
    for (Json& visual : visuals) {
      if (visual.at("kind") == "mesh_file") is_drawn = is_drawn && ReadMesh(&visual);
      if (visual.contains("colour") && colour.is_null()) colour = visual.at("colour");
    }
    for (Json shape : is_drawn ? visuals : link.at("shapes")) {
      shape["pose"] = JsonOf(Times(place.pose, PoseFrom(shape.at("pose"))));
      if (!is_drawn && !colour.is_null()) shape["colour"] = colour;
      shapes_[place.track].push_back(std::move(shape));
    }
  }

  void AddSensors() {
    for (Json sensor : scene_.at("sensors")) {
      const Place& place = places_.at(sensor.at("link"));
      sensor["track"] = place.track;
      sensor["pose"] = JsonOf(Times(place.pose, PoseFrom(sensor.at("pose"))));
      sensors_.push_back(std::move(sensor));
    }
  }

  const Json scene_;
  ReplayScene found_;
  std::vector<Json> shapes_;  // of each track
  std::map<std::string, Place> places_;
  Json sensors_ = Json::array();
  Json meshes_;
  std::optional<Looks> looks_;
};

}  // namespace

LoadResult<ReplayScene> ReadReplayScene(const std::string& folder, MeshLooks looks) {
  const std::string path = folder + "/scene.json";
  const auto text = ReadFile(path);
  if (!text) return ReplayScene{};
  try {
    return SceneReader(Json::parse(*text), looks).Read();
  } catch (const std::exception&) {
    return LoadError{path + " is damaged; make the run again"};
  }
}

}  // namespace tcs::report
