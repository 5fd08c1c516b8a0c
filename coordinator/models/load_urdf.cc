#include "coordinator/models/load_urdf.h"

#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include "coordinator/errors/visible.h"
#include "coordinator/models/mend_masses.h"
#include "coordinator/models/model_mistake.h"
#include "coordinator/models/urdf_customs.h"
#include "coordinator/models/urdf_friction.h"
#include "coordinator/models/urdf_grammar.h"
#include "coordinator/models/urdf_skeleton.h"
#include "coordinator/models/urdf_values.h"
#include "coordinator/models/urdf_xml.h"
#include "coordinator/models/xacro.h"
#include "simbody_bridge/model/rigid_tree.h"
#include "simbody_bridge/model/vectors.h"

namespace tcs {
namespace {

using tinyxml2::XMLElement;

// The user of the model says where its joints start: 0 need not be within the limits.
RobotModel WithAStart(RobotModel model) {
  for (Joint& joint : model.joints) {
    const JointLimits& limits = joint.limits;
    if (limits.lower > 0 && limits.lower <= limits.upper) joint.initial_position = {limits.lower};
    if (limits.upper < 0 && limits.lower <= limits.upper) joint.initial_position = {limits.upper};
    if (joint.mimic.has_value()) joint.initial_position.clear();
  }
  return model;
}

bool NoteAxes(const UrdfSkeleton& skeleton, const RobotModel& model, UrdfNotes* notes) {
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const Joint& joint = model.joints[i];
    if (joint.kind == JointKind::kFixed || joint.kind == JointKind::kFloating) continue;
    if (Dot(joint.axis, joint.axis) > 1e-12) continue;
    notes->AddMistake(LineOf(skeleton.joint(i)),
                      "joint '" + joint.name + "': its axis has no direction");
  }
  return !notes->HasMistakes();
}

// A free base without mass is fixed, as in Gazebo, MuJoCo and PyBullet: it could not move.
void FixMasslessBase(const UrdfSkeleton& skeleton, RobotModel* model, UrdfNotes* notes) {
  if (model->has_fixed_base) return;
  const RigidTree tree = MakeTree(*model);
  if (tree.bodies.front().mass_kg > 0) return;
  model->has_fixed_base = true;
  const auto root = static_cast<std::size_t>(model->root);
  notes->AddWarning(LineOf(skeleton.link(root)),
                    "link '" + model->links[root].name +
                        "' is the root and has no mass, so it is fixed to the world; write "
                        "fixed_base: true in the scenario, or give it an inertial");
}

void SetFriction(const tinyxml2::XMLDocument& document, const UrdfUse& use, RobotModel* model) {
  const std::map<std::string, double> of_links = FrictionOfLinks(document);
  for (Link& link : model->links) {
    const auto own = of_links.find(link.name);
    for (Shape& shape : link.shapes) {
      if (own != of_links.end()) shape.friction = own->second;
      if (use.friction) shape.friction = *use.friction;
    }
  }
}

// Nothing but how the robot looks depends on visuals.
void NoteMissingVisuals(const tinyxml2::XMLDocument& document, const UrdfSurroundings& around,
                        UrdfNotes* notes) {
  for (const XMLElement* link = document.RootElement()->FirstChildElement("link"); link != nullptr;
       link = link->NextSiblingElement("link")) {
    for (const XMLElement* visual = link->FirstChildElement("visual"); visual != nullptr;
         visual = visual->NextSiblingElement("visual")) {
      const XMLElement* geometry = visual->FirstChildElement("geometry");
      const XMLElement* mesh = geometry == nullptr ? nullptr : geometry->FirstChildElement("mesh");
      const char* name = mesh == nullptr ? nullptr : mesh->Attribute("filename");
      if (name == nullptr) continue;
      const auto note = [&](const std::string& why) {
        notes->AddMend("missing visual", mesh->GetLineNum(),
                       OwnerOf(*link) + " is drawn without a mesh: " + why);
      };
      try {
        const std::string path = around.packages.Find(name, around.described_in);
        std::error_code error;
        if (!std::filesystem::exists(path, error)) note(path + " does not exist");
      } catch (const ModelMistake& mistake) {
        note(mistake.message);
      }
    }
  }
}

RobotModel Load(const tinyxml2::XMLDocument& document, const UrdfUse& use,
                const UrdfSurroundings& around, UrdfNotes* notes) {
  const auto understood = UnderstoodPart(document, notes);
  WithCustoms(understood.get(), notes);
  const UrdfSkeleton skeleton(*understood, notes);
  if (notes->HasMistakes()) return {};
  RobotModel model = WithValues(skeleton, *understood, around, notes);
  model.has_fixed_base = use.has_fixed_base;
  if (!NoteAxes(skeleton, model, notes)) return {};
  SetFriction(document, use, &model);
  FixMasslessBase(skeleton, &model, notes);
  MendMasses(
      &model, [&](std::size_t link) { return LineOf(skeleton.link(link)); }, notes);
  skeleton.NoteFaultOf(WithAStart(model), notes);
  NoteMissingVisuals(document, around, notes);
  return model;
}

}  // namespace

std::variant<LoadedUrdf, std::vector<LoadError>> LoadUrdf(const std::string& path,
                                                          const UrdfUse& use,
                                                          const PackagePath& packages,
                                                          MeshLibrary* meshes,
                                                          UrdfRemarks* remarks) {
  LoadedUrdf loaded;
  std::vector<LoadError> errors;
  const bool is_xacro = HasXacro() && (!use.xacro_arguments.empty() || IsXacroFile(path));
  UrdfNotes notes(is_xacro ? path + " as xacro expands it" : path);
  try {
    if (is_xacro) loaded.expanded = ExpandedByXacro(path, use.xacro_arguments);
    const auto document = is_xacro ? ParseUrdf(notes.path(), loaded.expanded) : ReadUrdfXml(path);
    loaded.model = Load(*document, use, {packages, *meshes, path}, &notes);
  } catch (const ModelMistake& mistake) {
    errors.push_back({Visible(mistake.message)});  // names of files are whatever they are
  }
  for (std::string& sentence : notes.Mistakes()) errors.push_back({std::move(sentence)});
  notes.Tell(remarks);
  if (!errors.empty()) return errors;
  return loaded;
}

}  // namespace tcs
