#include "simbody_bridge/joints/dry_friction.h"

#include <Eigen/Cholesky>
#include <utility>

#include "simbody_bridge/joints/branches.h"

namespace tcs {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A row that misses by no more than this of what it is made of is right.
constexpr double kRounding = 1e-12;
// Rounds in which all rows that are wrong change at once; if that does not get better for so long,
// only the first wrong row changes, which always ends (Murty).
constexpr int kPatience = 5;

// Finds which rows are held, by rounds.
class Holds {
 public:
  Holds(const VectorXd& bounds, std::vector<int>* at, VectorXd* hold)
      : bounds_(bounds), at_(*at), hold_(*hold) {
    hold_.resize(bounds.size());
  }
  Holds(const Holds&) = delete;
  Holds& operator=(const Holds&) = delete;

  void Find() {
    const Index size = bounds_.size();
    Index fewest = size + 1;
    int patience = kPatience;
    // No more than a guard: each round solves a system.
    for (Index round = 0; round < 50 + 4 * size; ++round) {
      Solve();
      FindWrong();
      const auto wrong = static_cast<Index>(wrong_.size());
      if (wrong == 0) return;
      if (wrong < fewest) {
        fewest = wrong;
        patience = kPatience;
      } else if (patience > 0) {
        --patience;
      }
      for (const auto& [row, to] : wrong_) {
        at_[static_cast<std::size_t>(row)] = to;
        if (patience == 0) break;
      }
    }
  }

 protected:
  ~Holds() = default;

  int At(Index row) const { return at_[static_cast<std::size_t>(row)]; }

  // Rows that are held come to rest: finds the efforts that hold them, and the speeds of the other
  // rows.
  virtual void Solve() = 0;
  // The speed that the row's bound gives to the row.
  virtual double SpeedByBound(Index row) const = 0;

  const VectorXd& bounds_;
  std::vector<int>& at_;  // which bound: -1, 1; 0: the row is held
  VectorXd& hold_;
  VectorXd w_;  // the speeds

 private:
  void FindWrong() {
    wrong_.clear();
    for (Index row = 0; row < bounds_.size(); ++row) {
      const double bound = bounds_[row];
      if (At(row) == 0) {
        if (hold_[row] > bound * (1 + kRounding)) wrong_.emplace_back(row, 1);
        if (hold_[row] < -bound * (1 + kRounding)) wrong_.emplace_back(row, -1);
      } else if (At(row) * w_[row] > kRounding * SpeedByBound(row)) {
        wrong_.emplace_back(row, 0);
      }
    }
  }

  std::vector<std::pair<Index, int>> wrong_;
};

// For a problem in which the effect of each effort is known.
class HoldsByEffort final : public Holds {
 public:
  HoldsByEffort(const MatrixXd& by_effort, const VectorXd& moves, const VectorXd& bounds,
                std::vector<int>* at, VectorXd* hold)
      : Holds(bounds, at, hold), by_effort_(by_effort), moves_(moves) {}

 private:
  void Solve() override {
    held_.clear();
    for (Index row = 0; row < moves_.size(); ++row) {
      hold_[row] = At(row) * bounds_[row];
      if (At(row) == 0) held_.push_back(row);
    }
    w_ = moves_ + by_effort_ * hold_;
    if (held_.empty()) return;
    const MatrixXd held = by_effort_(held_, held_);
    const VectorXd efforts = held.llt().solve(VectorXd(-w_(held_)));
    for (std::size_t i = 0; i < held_.size(); ++i) {
      hold_[held_[i]] = efforts[static_cast<Index>(i)];
    }
    w_ = moves_ + by_effort_ * hold_;
  }
  double SpeedByBound(Index row) const override { return by_effort_(row, row) * bounds_[row]; }

  const MatrixXd& by_effort_;
  const VectorXd& moves_;
  std::vector<Index> held_;
};

// For a problem in which the motion is found by a system: rows that are held leave the system, so
// that the fewer rows move the less there is to solve.
class HoldsInSystem final : public Holds {
 public:
  HoldsInSystem(const MatrixXd& system, const VectorXd& impulses, const std::vector<Index>& rubbing,
                const VectorXd& speeds, const VectorXd& bounds, std::vector<int>* at,
                VectorXd* hold, VectorXd* change)
      : Holds(bounds, at, hold),
        system_(system),
        impulses_(impulses),
        rubbing_(rubbing),
        speeds_(speeds),
        change_(*change) {}

 private:
  void Solve() override {
    std::vector<bool> is_held(static_cast<std::size_t>(system_.rows()), false);
    change_.setZero(system_.rows());
    pushes_ = impulses_;
    for (std::size_t i = 0; i < rubbing_.size(); ++i) {
      const auto row = static_cast<Index>(i);
      hold_[row] = At(row) * bounds_[row];
      pushes_[rubbing_[i]] += hold_[row];
      if (At(row) != 0) continue;
      is_held[static_cast<std::size_t>(rubbing_[i])] = true;
      change_[rubbing_[i]] = -speeds_[row];
    }
    pushes_ -= system_ * change_;
    moving_.clear();
    for (Index speed = 0; speed < system_.rows(); ++speed) {
      if (!is_held[static_cast<std::size_t>(speed)]) moving_.push_back(speed);
    }
    if (!moving_.empty()) {
      moving_system_ = system_(moving_, moving_);
      moved_ = pushes_(moving_);
      SolveByBranches(&moving_system_, &moved_);
      change_(moving_) = moved_;
    }
    w_ = speeds_ + change_(rubbing_);
    for (std::size_t i = 0; i < rubbing_.size(); ++i) {
      const auto row = static_cast<Index>(i);
      if (At(row) == 0) {
        hold_[row] = system_.row(rubbing_[i]).dot(change_) - impulses_[rubbing_[i]];
      }
    }
  }
  double SpeedByBound(Index row) const override {
    const Index speed = rubbing_[static_cast<std::size_t>(row)];
    return bounds_[row] / system_(speed, speed);
  }

  const MatrixXd& system_;
  const VectorXd& impulses_;
  const std::vector<Index>& rubbing_;
  const VectorXd& speeds_;
  VectorXd& change_;
  VectorXd pushes_, moved_;
  MatrixXd moving_system_;
  std::vector<Index> moving_;
};

}  // namespace

void FindHolds(const MatrixXd& by_effort, const VectorXd& moves, const VectorXd& bounds,
               VectorXd* hold) {
  std::vector<int> at(static_cast<std::size_t>(moves.size()), 0);
  HoldsByEffort(by_effort, moves, bounds, &at, hold).Find();
}

void FindHeldChange(const MatrixXd& system, const VectorXd& impulses,
                    const std::vector<Index>& rubbing, const VectorXd& speeds,
                    const VectorXd& bounds, std::vector<int>* at, VectorXd* hold,
                    VectorXd* change) {
  HoldsInSystem(system, impulses, rubbing, speeds, bounds, at, hold, change).Find();
}

}  // namespace tcs
