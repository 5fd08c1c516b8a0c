#include "tests/unit/engines/dart_scene.h"

#include <Eigen/Geometry>
#include <cmath>
#include <dart/collision/dart/DARTCollisionDetector.hpp>
#include <dart/constraint/ConstraintSolver.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/CylinderShape.hpp>
#include <dart/dynamics/DegreeOfFreedom.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/dynamics/SphereShape.hpp>
#include <dart/dynamics/WeldJoint.hpp>
#include <dart/simulation/World.hpp>
#include <dart/utils/urdf/DartLoader.hpp>
#include <stdexcept>
#include <variant>

#include "tests/unit/engines/to_eigen.h"

namespace tcs {
namespace {

using namespace dart::dynamics;
using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kStepS = 1e-3;

// DART's own detector knows no planes.
constexpr double kSlabM = 40;

ShapePtr DartShape(const Geometry& geometry) {
  if (const auto* box = std::get_if<tcs::BoxShape>(&geometry)) {
    return std::make_shared<dart::dynamics::BoxShape>(ToEigen(box->size_m));
  }
  if (const auto* ball = std::get_if<tcs::SphereShape>(&geometry)) {
    return std::make_shared<dart::dynamics::SphereShape>(ball->radius_m);
  }
  if (std::holds_alternative<tcs::PlaneShape>(geometry)) {
    return std::make_shared<dart::dynamics::BoxShape>(Vector3d(kSlabM, kSlabM, 1));
  }
  throw std::runtime_error("a scene on DART has boxes, balls and planes");
}

Isometry3d PlaceOf(const tcs::Shape& shape) {
  Isometry3d at = ToEigen(shape.pose);
  if (std::holds_alternative<tcs::PlaneShape>(shape.geometry)) at.translate(Vector3d(0, 0, -0.5));
  return at;
}

void AddShape(const tcs::Shape& shape, BodyNode* body) {
  ShapeNode* node =
      body->createShapeNodeWith<CollisionAspect, DynamicsAspect>(DartShape(shape.geometry));
  node->setRelativeTransform(PlaceOf(shape));
  node->getDynamicsAspect()->setFrictionCoeff(shape.friction);
}

}  // namespace

class DartScene::World {
 public:
  explicit World(const WorldSpec& world) {
    world_->setTimeStep(kStepS);
    world_->setGravity(ToEigen(world.gravity_mps2));
    world_->getConstraintSolver()->setCollisionDetector(
        dart::collision::DARTCollisionDetector::create());
    for (const tcs::Shape& fixture : world.fixtures) {
      const SkeletonPtr skeleton =
          Skeleton::create("fixture" + std::to_string(world_->getNumSkeletons()));
      AddShape(fixture, skeleton->createJointAndBodyNodePair<WeldJoint>().second);
      world_->addSkeleton(skeleton);
    }
    for (const RobotModel& model : world.models) AddBody(model);
  }

  void AddRobot(const std::string& urdf, const RobotModel& start, double friction, double stiffness,
                double damping) {
    dart::utils::DartLoader loader;
    const SkeletonPtr skeleton = loader.parseSkeleton("file://" + urdf);
    if (skeleton == nullptr) throw std::runtime_error("DART cannot read " + urdf);
    skeleton->setName(start.name);
    for (BodyNode* body : skeleton->getBodyNodes()) {
      for (ShapeNode* node : body->getShapeNodesWith<DynamicsAspect>()) {
        node->getDynamicsAspect()->setFrictionCoeff(friction);
        // It would complain at each step.
        if (node->getShape()->is<dart::dynamics::CylinderShape>()) node->removeCollisionAspect();
      }
    }
    dynamic_cast<FreeJoint&>(*skeleton->getRootJoint()).setTransform(ToEigen(start.at));
    for (const tcs::Joint& joint : start.joints) {
      if (joint.kind == JointKind::kFixed) continue;
      DegreeOfFreedom* dof = skeleton->getDof(joint.name);
      const double at = joint.initial_position.empty() ? 0 : joint.initial_position[0];
      dof->setPosition(at);
      dof->setRestPosition(at);
      dof->setSpringStiffness(stiffness);
      dof->setDampingCoefficient(dof->getDampingCoefficient() + damping);
      dof->getJoint()->setLimitEnforcement(true);
    }
    world_->addSkeleton(skeleton);
  }

  void Advance(double seconds) {
    for (long left = std::lround(seconds / kStepS); left > 0; --left) world_->step();
  }

  LinkState StateOf(std::string_view model) const {
    const BodyNode* body = Find(model)->getRootBodyNode();
    const Isometry3d& at = body->getWorldTransform();
    const Quaterniond q(at.linear());
    const Vector3d p = at.translation(), v = body->getLinearVelocity(),
                   turning = body->getAngularVelocity();
    return {{{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()}},
            {v.x(), v.y(), v.z()},
            {turning.x(), turning.y(), turning.z()}};
  }

  double LiftOn(std::string_view model) const {
    double lift = 0;
    const SkeletonPtr skeleton = Find(model);
    for (std::size_t i = 0; i < skeleton->getNumBodyNodes(); ++i) {
      const BodyNode* body = skeleton->getBodyNode(i);
      // Along the body's axes: torque, then force.
      const Vector3d force = body->getConstraintImpulse().tail<3>() / kStepS;
      lift += (body->getWorldTransform().linear() * force).z();
    }
    return lift;
  }

 private:
  SkeletonPtr Find(std::string_view model) const {
    SkeletonPtr skeleton = world_->getSkeleton(std::string(model));
    if (skeleton == nullptr) throw std::runtime_error("DART has no " + std::string(model));
    return skeleton;
  }

  void AddBody(const RobotModel& model) {
    const SkeletonPtr skeleton = Skeleton::create(model.name);
    const auto [joint, body] = skeleton->createJointAndBodyNodePair<FreeJoint>();
    const tcs::Inertial& of = *model.links[0].inertial;
    body->setInertia(Inertia(of.mass_kg, Vector3d::Zero(),
                             Vector3d(of.ixx_kgm2, of.iyy_kgm2, of.izz_kgm2).asDiagonal()));
    for (const tcs::Shape& shape : model.links[0].shapes) AddShape(shape, body);
    joint->setTransform(ToEigen(model.at));
    world_->addSkeleton(skeleton);
  }

  dart::simulation::WorldPtr world_ = dart::simulation::World::create();
};

DartScene::DartScene(const WorldSpec& world) : world_(std::make_unique<World>(world)) {}
DartScene::~DartScene() = default;

void DartScene::AddRobot(const std::string& urdf, const RobotModel& start, double friction,
                         double stiffness, double damping) {
  world_->AddRobot(urdf, start, friction, stiffness, damping);
}
void DartScene::Advance(double seconds) { world_->Advance(seconds); }
LinkState DartScene::StateOf(std::string_view model) const { return world_->StateOf(model); }
double DartScene::LiftOn(std::string_view model) const { return world_->LiftOn(model); }

}  // namespace tcs
