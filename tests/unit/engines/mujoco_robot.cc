#include "tests/unit/engines/mujoco_robot.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>

namespace tcs {

class MujocoRobot::Loaded {
 public:
  Loaded(const std::string& urdf, const std::array<double, 3>& gravity_mps2, double step_s) {
    constexpr const char* kName = "robot.urdf";
    const auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    mj_makeEmptyFileVFS(files.get(), kName, static_cast<int>(urdf.size()));
    std::memcpy(files->filedata[0], urdf.data(), urdf.size());
    std::array<char, 1000> error{};
    model_ = mj_loadXML(kName, files.get(), error.data(), static_cast<int>(error.size()));
    mj_deleteFileVFS(files.get(), kName);
    if (model_ == nullptr) throw std::runtime_error(error.data());
    model_->opt.integrator = mjINT_RK4;
    model_->opt.timestep = step_s;
    model_->opt.disableflags |= mjDSBL_CONTACT | mjDSBL_LIMIT | mjDSBL_FRICTIONLOSS;
    std::copy(gravity_mps2.begin(), gravity_mps2.end(), model_->opt.gravity);
    data_ = mj_makeData(model_);
  }
  ~Loaded() {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }
  Loaded(const Loaded&) = delete;
  Loaded& operator=(const Loaded&) = delete;

  int Find(const std::string& joint) const {
    const int id = mj_name2id(model_, mjOBJ_JOINT, joint.c_str());
    if (id < 0) throw std::runtime_error("MuJoCo has no joint " + joint);
    return id;
  }
  void Set(int joint, double position, double velocity) {
    data_->qpos[model_->jnt_qposadr[joint]] = position;
    data_->qvel[model_->jnt_dofadr[joint]] = velocity;
  }
  double PositionOf(int joint) const { return data_->qpos[model_->jnt_qposadr[joint]]; }
  void Advance(int steps) {
    for (int i = 0; i < steps; ++i) mj_step(model_, data_);
  }

 private:
  mjModel* model_ = nullptr;
  mjData* data_ = nullptr;
};

MujocoRobot::MujocoRobot(const std::string& urdf, const std::array<double, 3>& gravity_mps2,
                         double step_s)
    : loaded_(std::make_unique<Loaded>(urdf, gravity_mps2, step_s)) {}
MujocoRobot::~MujocoRobot() = default;

void MujocoRobot::Set(const std::string& joint, double position, double velocity) {
  loaded_->Set(loaded_->Find(joint), position, velocity);
}
double MujocoRobot::PositionOf(const std::string& joint) const {
  return loaded_->PositionOf(loaded_->Find(joint));
}
void MujocoRobot::Advance(int steps) { loaded_->Advance(steps); }

}  // namespace tcs
