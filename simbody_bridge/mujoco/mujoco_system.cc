#include "simbody_bridge/mujoco/mujoco_system.h"

#include <errno.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "simbody_bridge/joints/joint_groups.h"
#include "simbody_bridge/model/vectors.h"
#include "simbody_bridge/mujoco/mjcf.h"
#include "simbody_bridge/one_line.h"

namespace tcs {
namespace {

using Vector = std::array<double, 3>;

// MuJoCo would end the process, and write its warnings into a file beside the scenario. The library
// is built with unwind tables, and holds no locks.
[[noreturn]] void ThrowError(const char* message) {
  throw DynamicsError("MuJoCo: " + OnOneLine(message));
}
void IgnoreWarning(const char* /*message*/) {}

// A file without a name. MuJoCo's own files in memory are two megabytes, whose page faults take a
// millisecond; and models meet, and are compiled, in the middle of a run.
class TextFile {
 public:
  explicit TextFile(const std::string& text) : fd_(memfd_create("tcs.xml", MFD_CLOEXEC)) {
    const auto size = static_cast<ssize_t>(text.size());
    if (fd_ < 0 || write(fd_, text.data(), text.size()) != size) {
      const int error = errno;
      if (fd_ >= 0) close(fd_);
      throw DynamicsError(fmt::format("MuJoCo has no room for the models: {}", strerror(error)));
    }
  }
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;
  ~TextFile() { close(fd_); }
  std::string path() const { return fmt::format("/proc/self/fd/{}", fd_); }

 private:
  const int fd_;
};

// MuJoCo's "WHY Object name = b3, id = …", by the names that the user knows.
std::string WhyRefused(std::string text, const Forest& forest) {
  text = OnOneLine(std::move(text));
  for (const std::string_view tail : {" Object name = ", " Element name ", " Element '"}) {
    const std::size_t at = text.find(tail);
    if (at == std::string::npos) continue;
    std::size_t number = 0;
    const char* first = text.data() + at + tail.size() + 1;
    const bool is_body = *(first - 1) == 'b';
    const auto read = std::from_chars(first, text.data() + text.size(), number);
    text.erase(at);
    if (read.ec != std::errc() || !is_body || number >= forest.bodies.size()) break;
    const Joint* joint = JointOfBody(forest, number);
    return joint == nullptr ? "its base: " + text
                            : fmt::format("what joint '{}' moves: {}", joint->name, text);
  }
  return text;
}

mjModel* Compile(const std::string& mjcf, const Forest& forest) {
  mju_user_error = &ThrowError;
  mju_user_warning = &IgnoreWarning;
  const TextFile file(mjcf);
  std::array<char, 1000> error{};
  mjModel* model = mj_loadXML(file.path().c_str(), nullptr, error.data(), error.size());
  if (model == nullptr) {
    throw DynamicsError("MuJoCo refuses it: " + WhyRefused(error.data(), forest));
  }
  return model;
}

}  // namespace

MujocoSystem::MujocoSystem(const Forest& forest, const std::array<double, 3>& gravity_mps2)
    : forest_(forest),
      model_(Compile(MjcfOf(forest, gravity_mps2), forest)),
      data_(mj_makeData(model_.get())) {
  if (data_ == nullptr)
    throw DynamicsError("MuJoCo cannot make its data; check whether memory is left");
  FindIds();
  inverse_inertias_.assign(model_->dof_invweight0, model_->dof_invweight0 + model_->nv);
  pairs_ = ShapePairs(forest, shapes_, *model_);
  if (HasDampingOrFriction(forest)) {
    joint_steps_ = std::make_unique<MujocoJointSteps>(forest, *model_, bodies_);
  }
  SetStart();
}

int MujocoSystem::IdOf(int type, char prefix, std::size_t index) const {
  return mj_name2id(model_.get(), type, fmt::format("{}{}", prefix, index).c_str());
}

void MujocoSystem::FindIds() {
  for (std::size_t i = 0; i < forest_.bodies.size(); ++i) {
    bodies_.push_back(IdOf(mjOBJ_BODY, 'b', i));
    body_actuators_.push_back(IdOf(mjOBJ_ACTUATOR, 'b', i));
  }
  along_body_.resize(forest_.bodies.size());
  for (std::size_t i = 0; i < forest_.joints.size(); ++i) {
    joint_actuators_.push_back(IdOf(mjOBJ_ACTUATOR, 'j', i));
    const int body = forest_.joints[i].body;
    const int joint =
        body == kWorldBody ? -1 : IdOf(mjOBJ_JOINT, 'b', static_cast<std::size_t>(body));
    positions_.push_back(joint < 0 ? -1 : model_->jnt_qposadr[joint]);
    speeds_.push_back(joint < 0 ? -1 : model_->jnt_dofadr[joint]);
  }
  shapes_.resize(static_cast<std::size_t>(model_->ngeom));
  for (std::size_t i = 0; i < forest_.shapes.size(); ++i) {
    shapes_[static_cast<std::size_t>(IdOf(mjOBJ_GEOM, 's', i))] = i;
    const int middle = IdOf(mjOBJ_GEOM, 'd', i);
    if (middle >= 0) shapes_[static_cast<std::size_t>(middle)] = i;
  }
}

void MujocoSystem::SetStart() {
  mj_resetData(model_.get(), data_.get());
  for (std::size_t i = 0; i < forest_.bodies.size(); ++i) SetPose(i);
  mj_forward(model_.get(), data_.get());
  const int positions = model_->nq, speeds = model_->nv;
  start_.assign(data_->qpos, data_->qpos + positions);
  start_.insert(start_.end(), data_->qvel, data_->qvel + speeds);
  start_.insert(start_.end(), static_cast<std::size_t>(speeds), 0);
}

// MuJoCo has quaternions w x y z, and the angular velocities of free and ball joints along the
// child's axes.
void MujocoSystem::SetPose(std::size_t index) {
  const TreeBody& body = forest_.bodies[index];
  const int last = IdOf(mjOBJ_JOINT, 'b', index);
  const int first = model_->body_jntadr[bodies_[index]];
  double* q = data_->qpos + model_->jnt_qposadr[first];
  double* u = data_->qvel + model_->jnt_dofadr[first];
  const std::vector<double>& at = body.position;
  const std::vector<double>& speed = body.velocity;
  std::copy_n(at.begin(), std::min<std::size_t>(3, at.size()), q);
  std::copy_n(speed.begin(), std::min<std::size_t>(3, speed.size()), u);
  if (body.kind != JointKind::kFloating) return;
  if (first != last) {
    q = data_->qpos + model_->jnt_qposadr[last];
    u = data_->qvel + model_->jnt_dofadr[last];
  } else {
    q += 3;
    u += 3;
  }
  const auto [x, y, z, w] = Normalised({at[3], at[4], at[5], at[6]});
  std::copy_n(std::array{w, x, y, z}.begin(), 4, q);
  const Vector turning = Rotate({-x, -y, -z, w}, {speed[3], speed[4], speed[5]});
  std::copy_n(turning.begin(), 3, u);
}

void MujocoSystem::SetState(std::span<const double> state) {
  const auto positions = static_cast<std::size_t>(model_->nq);
  const auto speeds = static_cast<std::size_t>(model_->nv);
  data_->time = 0;
  std::copy_n(state.data(), positions, data_->qpos);
  std::copy_n(state.data() + positions, speeds, data_->qvel);
  std::copy_n(state.data() + positions + speeds, speeds, data_->qacc_warmstart);
}

// A joint that takes no effort is not driven.
JointDrive MujocoSystem::DriveOf(std::span<const Wrench> acting, std::size_t joint) const {
  if (!(forest_.joints[joint].joint->limits.effort > 0)) return {};
  return DriveOfJoint(acting, forest_.links.size(), joint);
}

void MujocoSystem::SetDrive(std::size_t joint, const JointDrive& drive) {
  const int actuator = joint_actuators_[joint];
  data_->ctrl[actuator] =
      drive.effort + drive.stiffness * drive.position + drive.damping * drive.velocity;
  model_->actuator_biasprm[mjNBIAS * actuator + 1] = -drive.stiffness;
  model_->actuator_biasprm[mjNBIAS * actuator + 2] = -drive.damping;
}

// All wrenches along the axes of a body's links are one actuator of the body, which turns with the
// body: each actuator costs as much as a joint.
void MujocoSystem::ActOnLinks(std::span<const Wrench> acting) {
  std::fill_n(data_->xfrc_applied, 6 * model_->nbody, 0.0);
  std::fill(along_body_.begin(), along_body_.end(), Load{});
  bool knows_places = false;
  for (std::size_t i = 0; i < forest_.links.size(); ++i) {
    const TreeLink& link = forest_.links[i];
    if (link.body == kWorldBody) continue;
    const Load in_link = LoadOf(WrenchOnLink(acting, i, WrenchFrame::kLink));
    const Load in_world = LoadOf(WrenchOnLink(acting, i, WrenchFrame::kWorld));
    if (in_link != Load{}) {
      const Vector force = Rotate(link.pose.orientation_xyzw, in_link.force_n);
      Load& along = along_body_[static_cast<std::size_t>(link.body)];
      AddTo(&along, {force, Cross(link.pose.position_m, force)}, 1);
      AddTo(&along, {{}, Rotate(link.pose.orientation_xyzw, in_link.torque_nm)}, 1);
    }
    if (in_world != Load{}) {
      if (!std::exchange(knows_places, true)) mj_kinematics(model_.get(), data_.get());
      ActInWorld(link, in_world);
    }
  }
  for (std::size_t i = 0; i < along_body_.size(); ++i) {
    double* gear = model_->actuator_gear + 6 * body_actuators_[i];
    std::copy_n(along_body_[i].force_n.begin(), 3, gear);
    std::copy_n(along_body_[i].torque_nm.begin(), 3, gear + 3);
    data_->ctrl[body_actuators_[i]] = 1;
  }
}

// The load acts at the link's origin, on a body whose place is known.
void MujocoSystem::ActInWorld(const TreeLink& link, const Load& load) {
  const int body = bodies_[static_cast<std::size_t>(link.body)];
  const double* p = data_->xpos + 3 * body;
  const double* q = data_->xquat + 4 * body;
  const double* center = data_->xipos + 3 * body;
  const Vector arm = Rotate({q[1], q[2], q[3], q[0]}, link.pose.position_m);
  const Vector turn =
      Cross({p[0] + arm[0] - center[0], p[1] + arm[1] - center[1], p[2] + arm[2] - center[2]},
            load.force_n);
  double* applied = data_->xfrc_applied + 6 * body;
  for (std::size_t i = 0; i < 3; ++i) {
    applied[i] += load.force_n[i];
    applied[i + 3] += load.torque_nm[i] + turn[i];
  }
}

// After a failure MuJoCo would begin anew from its own start.
bool MujocoSystem::HasFailed() const {
  return data_->warning[mjWARN_BADQPOS].number > 0 || data_->warning[mjWARN_BADQVEL].number > 0 ||
         data_->warning[mjWARN_BADQACC].number > 0;
}

int MujocoSystem::BodyOfSpeed(int speed) const {
  const auto found = std::find(bodies_.begin(), bodies_.end(), model_->dof_bodyid[speed]);
  return found == bodies_.end() ? -1 : static_cast<int>(found - bodies_.begin());
}

// MuJoCo says by which number of the state a step failed: the part that this number moves has
// failed.
void MujocoSystem::FindFailedBody() {
  failed_body_ = -1;
  for (const int kind : {mjWARN_BADQACC, mjWARN_BADQVEL, mjWARN_BADQPOS}) {
    const mjWarningStat& warning = data_->warning[kind];
    if (warning.number == 0) continue;
    if (kind != mjWARN_BADQPOS) {
      if (warning.lastinfo < model_->nv) failed_body_ = BodyOfSpeed(warning.lastinfo);
      return;
    }
    for (int joint = 0; joint < model_->njnt; ++joint) {
      if (model_->jnt_qposadr[joint] > warning.lastinfo) break;
      failed_body_ = BodyOfSpeed(model_->jnt_dofadr[joint]);
    }
    return;
  }
}

// Whether Runge-Kutta 4, or the method that takes its place, bears the step: nothing touches, and
// no servo is as quick as the step, unless the servo acts in closed form.
bool MujocoSystem::IsSmooth(std::span<const Wrench> acting, double seconds) const {
  if (data_->ncon > 0) return false;
  for (std::size_t i = 0; i < joint_actuators_.size(); ++i) {
    if (joint_actuators_[i] < 0) continue;
    JointDrive drive = DriveOf(acting, i);
    if (joint_steps_ != nullptr) {
      drive.damping = 0;
      if (joint_steps_->TakeStiffnessOf(speeds_[i])) drive.stiffness = 0;
    }
    const double by_inertia = seconds * inverse_inertias_[static_cast<std::size_t>(speeds_[i])];
    if (by_inertia * std::max(drive.damping, seconds * drive.stiffness) > 1) return false;
  }
  return true;
}

bool MujocoSystem::IsInStop() const {
  return std::find(data_->efc_type, data_->efc_type + data_->nefc, mjCNSTR_LIMIT_JOINT) !=
         data_->efc_type + data_->nefc;
}

// Whether a servo would give more than it can: a kink, that closed forms do not have.
bool MujocoSystem::IsAtLimit(std::span<const Wrench> acting, std::size_t joint) const {
  const JointDrive drive = DriveOf(acting, joint);
  if (drive.stiffness <= 0 && drive.damping <= 0) return false;
  const double q = data_->qpos[positions_[joint]], u = data_->qvel[speeds_[joint]];
  const double limit = forest_.joints[joint].joint->limits.effort;
  return std::abs(EffortOf(drive, kNoLimit, q, u)) >= limit;
}

// False where a joint comes into a stop, a servo to its limit, or something touches: the data are
// then to be begun with again.
bool MujocoSystem::StepJoints(std::span<const Wrench> acting) {
  const auto speeds = static_cast<std::size_t>(model_->nv);
  slopes_.by_speed.assign(model_->dof_damping, model_->dof_damping + speeds);
  slopes_.by_coordinate.assign(speeds, 0);
  for (std::size_t i = 0; i < joint_actuators_.size(); ++i) {
    if (joint_actuators_[i] < 0) continue;
    const JointDrive drive = DriveOf(acting, i);
    if (IsAtLimit(acting, i)) return false;
    const auto speed = static_cast<std::size_t>(speeds_[i]);
    slopes_.by_speed[speed] += std::max(0.0, drive.damping);
    if (!joint_steps_->TakeStiffnessOf(speeds_[i])) continue;
    slopes_.by_coordinate[speed] = std::max(0.0, drive.stiffness);
  }
  const auto find = [this](const double* positions) {
    FindPositions(positions);
    if (data_->ncon > 0 || IsInStop()) return false;
    mj_fwdVelocity(model_.get(), data_.get());
    mj_fwdActuation(model_.get(), data_.get());
    mj_fwdAcceleration(model_.get(), data_.get());
    return true;
  };
  if (!joint_steps_->Step(*model_, data_.get(), slopes_, find)) return false;
  for (std::size_t i = 0; i < joint_actuators_.size(); ++i) {
    if (joint_actuators_[i] >= 0 && IsAtLimit(acting, i)) return false;
  }
  mj_checkPos(model_.get(), data_.get());
  mj_checkVel(model_.get(), data_.get());
  return true;
}

// As mj_fwdPosition, which puts quaternions in order. Where all was apart the last time, contacts
// are only looked for if something is near this time.
void MujocoSystem::FindPositions(const double* positions) {
  const auto find = [&](bool looks) {
    int& disabled = model_->opt.disableflags;
    disabled = looks ? disabled & ~mjDSBL_CONTACT : disabled | mjDSBL_CONTACT;
    std::copy_n(positions, model_->nq, data_->qpos);
    mj_fwdPosition(model_.get(), data_.get());
    return pairs_.AreApart(*model_, *data_);
  };
  const bool were_apart = std::exchange(are_apart_, find(!are_apart_));
  if (were_apart && !are_apart_) find(true);
}

// Finds the accelerations of positions that have been found.
void MujocoSystem::FindAccelerations() {
  mj_fwdActuation(model_.get(), data_.get());
  mj_fwdAcceleration(model_.get(), data_.get());
  mj_fwdConstraint(model_.get(), data_.get());
}

// As mj_forward.
void MujocoSystem::FindAll(const double* positions) {
  FindPositions(positions);
  mj_fwdVelocity(model_.get(), data_.get());
  FindAccelerations();
}

// The rest of what mj_step does.
void MujocoSystem::StepSmoothly() {
  mj_fwdVelocity(model_.get(), data_.get());
  FindAccelerations();
  mj_checkAcc(model_.get(), data_.get());
  if (HasFailed()) return;
  runge_kutta_.Step(*model_, data_.get(), [this](const double* positions) { FindAll(positions); });
}

// MuJoCo's stops, mimics and friction of joints are as soft as befits the inertia that it has found
// of them, once: beside the inertia that a servo adds they would be nothing.
void MujocoSystem::SetArmature(int speed, double inertia) {
  model_->dof_armature[speed] = inertia;
  const double inverse = inverse_inertias_[static_cast<std::size_t>(speed)];
  model_->dof_invweight0[speed] = inertia > 0 ? inverse / (1 + inertia * inverse) : inverse;
}

// Whether MuJoCo would find the positions again where they are: MuJoCo puts quaternions in order
// each time, which turns a third of them by a rounding.
bool MujocoSystem::AreInOrder() {
  begin_.assign(data_->qpos, data_->qpos + model_->nq);
  mj_normalizeQuat(model_.get(), begin_.data());
  return std::equal(begin_.begin(), begin_.end(), data_->qpos);
}

// A servo with the stiffness k and the damping d gives what it gives at the end of the step, where
// the joint is at q + h u' with the speed u'. This effort is what a damping d + h k gives at the
// beginning, less (d + h k) (u' - u): as if the joint had an inertia of h (d + h k) more, with
// which MuJoCo solves for everything else. A servo that would give more than it can is held to its
// limit, and all is solved again.
void MujocoSystem::StepImplicitly(std::span<const Wrench> acting, double seconds) {
  at_limit_.assign(joint_actuators_.size(), 0);
  bool has_velocities = false;
  do {
    for (std::size_t i = 0; i < joint_actuators_.size(); ++i) {
      if (joint_actuators_[i] < 0) continue;
      JointDrive drive = DriveOf(acting, i);
      drive.effort += drive.damping * std::exchange(drive.velocity, 0);
      drive.damping += seconds * drive.stiffness;
      if (at_limit_[i] != 0) drive = {.effort = at_limit_[i]};
      SetDrive(i, drive);
      model_->actuator_forcelimited[joint_actuators_[i]] = 0;
      SetArmature(speeds_[i], seconds * drive.damping);
    }
    if (AreInOrder()) {
      // Only inertia has changed.
      mj_crb(model_.get(), data_.get());
      mj_factorM(model_.get(), data_.get());
      if (!std::exchange(has_velocities, true)) mj_fwdVelocity(model_.get(), data_.get());
      FindAccelerations();
    } else {
      mj_forward(model_.get(), data_.get());
      has_velocities = true;
    }
  } while (ReachLimits(acting, seconds));
  mj_checkAcc(model_.get(), data_.get());
  mj_Euler(model_.get(), data_.get());
}

// Whether one more servo would give more than it can at the end of the step.
bool MujocoSystem::ReachLimits(std::span<const Wrench> acting, double seconds) {
  bool is_new = false;
  for (std::size_t i = 0; i < joint_actuators_.size(); ++i) {
    if (joint_actuators_[i] < 0 || at_limit_[i] != 0) continue;
    const JointDrive drive = DriveOf(acting, i);
    const double limit = forest_.joints[i].joint->limits.effort;
    const double u = data_->qvel[speeds_[i]] + seconds * data_->qacc[speeds_[i]];
    const double q = data_->qpos[positions_[i]] + seconds * u;
    if (EffortOf(drive, kNoLimit, q, u) == EffortOf(drive, limit, q, u)) continue;
    at_limit_[i] = EffortOf(drive, limit, q, u);
    is_new = true;
  }
  return is_new;
}

// The part that the two kinds of steps have in common.
void MujocoSystem::Begin(std::span<const double> from, std::span<const Wrench> acting,
                         double seconds) {
  for (mjWarningStat& warning : data_->warning) warning.number = 0;
  SetState(from);
  ActOnLinks(acting);
  for (std::size_t i = 0; i < joint_actuators_.size(); ++i) {
    if (joint_actuators_[i] < 0) continue;
    SetDrive(i, DriveOf(acting, i));
    const bool is_limited = forest_.joints[i].joint->limits.effort != kNoLimit;
    model_->actuator_forcelimited[joint_actuators_[i]] = is_limited ? 1 : 0;
    SetArmature(speeds_[i], 0);
  }
  model_->opt.timestep = seconds;
  mj_checkPos(model_.get(), data_.get());
  mj_checkVel(model_.get(), data_.get());
  begin_.assign(data_->qpos, data_->qpos + model_->nq);
  FindPositions(begin_.data());
}

// Whether the step was one of joints with damping or friction, and has been taken; else the data
// are as at the step's beginning.
bool MujocoSystem::TakesJoints(std::span<const double> from, std::span<const Wrench> acting,
                               double seconds) {
  if (joint_steps_ == nullptr || !IsSmooth(acting, seconds) || IsInStop()) return false;
  if (StepJoints(acting)) return true;
  Begin(from, acting, seconds);
  return false;
}

void MujocoSystem::Step(std::span<const double> from, std::span<const Wrench> acting,
                        double seconds, std::vector<double>* to) {
  Begin(from, acting, seconds);
  if (TakesJoints(from, acting, seconds)) {
    // Contacts are left to the next step.
  } else if (joint_steps_ == nullptr && IsSmooth(acting, seconds)) {
    StepSmoothly();
  } else {
    StepImplicitly(acting, seconds);
  }
  if (HasFailed()) {
    FindFailedBody();
    to->assign(from.size(), std::numeric_limits<double>::quiet_NaN());
    return;
  }
  to->assign(data_->qpos, data_->qpos + model_->nq);
  to->insert(to->end(), data_->qvel, data_->qvel + model_->nv);
  to->insert(to->end(), data_->qacc_warmstart, data_->qacc_warmstart + model_->nv);
}

// MuJoCo's normal points from the first geom to the second one, and its force acts on the second.
void MujocoSystem::AddForces(double share, std::vector<ShapeContact>* contacts) const {
  for (int i = 0; i < data_->ncon; ++i) {
    const mjContact& contact = data_->contact[i];
    if (contact.efc_address < 0) continue;
    std::array<double, 6> by_axis{};  // force and torque along the axes of the contact's frame
    mj_contactForce(model_.get(), data_.get(), i, by_axis.data());
    ShapeContact found{shapes_[static_cast<std::size_t>(contact.geom2)],
                       shapes_[static_cast<std::size_t>(contact.geom1)],
                       {},
                       {},
                       {}};
    for (std::size_t k = 0; k < 3; ++k) {
      found.point_m[k] = contact.pos[k];
      found.normal[k] = contact.frame[k];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        found.force_n[k] += share * by_axis[axis] * contact.frame[3 * axis + k];
      }
    }
    contacts->push_back(found);
  }
}

// A smooth step begins without contacts, but may come to some: these are the contacts of the stages
// of Runge-Kutta 4, each as far as its stage counts.
void MujocoSystem::AddForcesOfStages(double seconds, std::vector<ShapeContact>* contacts) {
  const auto positions = static_cast<std::size_t>(model_->nq);
  const auto speeds = static_cast<std::size_t>(model_->nv);
  const std::vector<double> q(data_->qpos, data_->qpos + positions);
  const std::vector<double> u(data_->qvel, data_->qvel + speeds);
  FindAll(q.data());
  constexpr std::array<std::pair<double, double>, 3> kStages = {
      {{0.5, 1.0 / 3}, {0.5, 1.0 / 3}, {1, 1.0 / 6}}};  // how far on, and how much it counts
  for (const auto& [on, share] : kStages) {
    const std::vector<double> speed(data_->qvel, data_->qvel + speeds);
    const std::vector<double> rate(data_->qacc, data_->qacc + speeds);
    std::vector<double> at = q;
    mj_integratePos(model_.get(), at.data(), speed.data(), on * seconds);
    for (std::size_t i = 0; i < speeds; ++i) data_->qvel[i] = u[i] + on * seconds * rate[i];
    FindAll(at.data());
    AddForces(share, contacts);
  }
}

void MujocoSystem::FindForces(std::span<const double> from, std::span<const Wrench> acting,
                              double seconds, std::vector<ShapeContact>* contacts) {
  contacts->clear();
  Begin(from, acting, seconds);
  if (TakesJoints(from, acting, seconds)) return;
  if (joint_steps_ == nullptr && IsSmooth(acting, seconds)) {
    AddForcesOfStages(seconds, contacts);
  } else {
    StepImplicitly(acting, seconds);
    AddForces(1, contacts);
  }
}

void MujocoSystem::CopyBody(std::size_t body, std::span<const double> state, const MujocoSystem& to,
                            std::size_t to_body, std::span<double> into) const {
  const int from_joint = model_->body_jntadr[bodies_[body]];
  const int to_joint = to.model_->body_jntadr[to.bodies_[to_body]];
  if (from_joint < 0) return;
  const int last = from_joint + model_->body_jntnum[bodies_[body]] - 1;
  const bool is_free = model_->jnt_type[last] == mjJNT_FREE;
  const bool is_ball = model_->jnt_type[last] == mjJNT_BALL;
  const int positions = model_->jnt_qposadr[last] - model_->jnt_qposadr[from_joint] +
                        (is_free   ? 7
                         : is_ball ? 4
                                   : 1);
  const int speeds = model_->jnt_dofadr[last] - model_->jnt_dofadr[from_joint] +
                     (is_free   ? 6
                      : is_ball ? 3
                                : 1);
  const auto copy = [&](int from, int at, int count) {
    std::copy_n(state.begin() + from, count, into.begin() + at);
  };
  copy(model_->jnt_qposadr[from_joint], to.model_->jnt_qposadr[to_joint], positions);
  const int from_speed = model_->jnt_dofadr[from_joint], to_speed = to.model_->jnt_dofadr[to_joint];
  copy(model_->nq + from_speed, to.model_->nq + to_speed, speeds);
  // The solver's guess.
  copy(model_->nq + model_->nv + from_speed, to.model_->nq + to.model_->nv + to_speed, speeds);
}

void MujocoSystem::ReadLinks(std::span<const double> state, std::span<const int> links,
                             std::span<LinkState> read) {
  SetState(state);
  mj_kinematics(model_.get(), data_.get());
  mj_comPos(model_.get(), data_.get());
  mj_comVel(model_.get(), data_.get());
  for (std::size_t i = 0; i < links.size(); ++i) {
    const TreeLink& link = forest_.links[static_cast<std::size_t>(links[i])];
    LinkState& of_link = read[i];
    if (link.body == kWorldBody) {
      of_link = {link.pose, {}, {}};
      continue;
    }
    const int body = bodies_[static_cast<std::size_t>(link.body)];
    const double* p = data_->xpos + 3 * body;
    const double* q = data_->xquat + 4 * body;
    const Pose pose{{p[0], p[1], p[2]}, {q[1], q[2], q[3], q[0]}};
    of_link.pose = Times(pose, link.pose);
    std::array<double, 6> speed{};  // turning, then moving, at the body's origin
    mj_objectVelocity(model_.get(), data_.get(), mjOBJ_XBODY, body, speed.data(), 0);
    const Vector turning = {speed[0], speed[1], speed[2]};
    const Vector around = Cross(turning, Rotate(pose.orientation_xyzw, link.pose.position_m));
    of_link.angular_velocity_radps = turning;
    for (std::size_t k = 0; k < 3; ++k) of_link.linear_velocity_mps[k] = speed[k + 3] + around[k];
  }
}

void MujocoSystem::ReadJoints(std::span<const double> state, std::span<const Wrench> acting,
                              std::span<const int> joints, std::span<JointState> read) const {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto joint = static_cast<std::size_t>(joints[i]);
    if (positions_[joint] < 0) {
      read[i] = {};
      continue;
    }
    const double q = state[static_cast<std::size_t>(positions_[joint])];
    const double u = state[static_cast<std::size_t>(model_->nq + speeds_[joint])];
    const JointDrive drive = DriveOfJoint(acting, forest_.links.size(), joint);
    read[i] = {q, u, EffortOf(drive, forest_.joints[joint].joint->limits.effort, q, u)};
  }
}

}  // namespace tcs
