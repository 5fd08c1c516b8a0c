#include "coordinator/models/load_urdf.h"

#include "coordinator/models/model_mistake.h"
#include "coordinator/models/urdf_grammar.h"
#include "coordinator/models/urdf_skeleton.h"
#include "coordinator/models/urdf_values.h"
#include "coordinator/models/urdf_xml.h"
#include "coordinator/os/visible.h"

namespace tcs {
namespace {

// Whoever uses the model says where its joints start: 0 need not be within the limits.
RobotModel WithAStart(RobotModel model) {
  for (Joint& joint : model.joints) {
    const JointLimits& limits = joint.limits;
    if (limits.lower > 0 && limits.lower <= limits.upper) joint.initial_position = {limits.lower};
    if (limits.upper < 0 && limits.lower <= limits.upper) joint.initial_position = {limits.upper};
    if (joint.mimic.has_value()) joint.initial_position.clear();
  }
  return model;
}

RobotModel Load(const std::string& path, const UrdfUse& use, const PackagePath& packages,
                MeshLibrary* meshes, std::vector<std::string>* warnings) {
  const auto document = ReadUrdfXml(path);
  const auto understood = UnderstoodPart(path, *document, warnings);
  const UrdfSkeleton skeleton(path, *document);
  RobotModel model = WithValues(skeleton, *understood, {packages, *meshes, use.friction}, warnings);
  model.has_fixed_base = use.has_fixed_base;
  skeleton.FailOnFaultOf(WithAStart(model));
  return model;
}

}  // namespace

LoadResult<RobotModel> LoadUrdf(const std::string& path, const UrdfUse& use,
                                const PackagePath& packages, MeshLibrary* meshes,
                                std::vector<std::string>* warnings) {
  try {
    return Load(path, use, packages, meshes, warnings);
  } catch (const ModelMistake& mistake) {
    return LoadError{Visible(mistake.message)};  // names of files are whatever they are
  }
}

}  // namespace tcs
