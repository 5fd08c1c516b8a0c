#include "simbody_bridge/joints/dry_friction.h"

#include <Eigen/Cholesky>
#include <vector>

namespace tcs {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A row that misses by no more than this of what it is made of is right.
constexpr double kRounding = 1e-12;
// Rounds in which all rows that are wrong change at once; if that does not get better for so long,
// only the first one does, which always ends (Murty).
constexpr int kPatience = 5;

class Holds {
 public:
  Holds(const MatrixXd& by_effort, const VectorXd& moves, const VectorXd& bounds, VectorXd* hold)
      : by_effort_(by_effort), moves_(moves), bounds_(bounds), hold_(*hold) {
    at_.assign(static_cast<std::size_t>(moves.size()), 0);
    hold_.resize(moves.size());
  }

  void Find() {
    const Index size = moves_.size();
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

 private:
  int& At(Index row) { return at_[static_cast<std::size_t>(row)]; }

  // Those within their bounds come to rest.
  void Solve() {
    free_.clear();
    for (Index row = 0; row < moves_.size(); ++row) {
      hold_[row] = At(row) * bounds_[row];
      if (At(row) == 0) free_.push_back(row);
    }
    w_ = moves_ + by_effort_ * hold_;
    if (free_.empty()) return;
    const MatrixXd held = by_effort_(free_, free_);
    const VectorXd efforts = held.llt().solve(VectorXd(-w_(free_)));
    for (std::size_t i = 0; i < free_.size(); ++i) {
      hold_[free_[i]] = efforts[static_cast<Index>(i)];
    }
    w_ = moves_ + by_effort_ * hold_;
  }

  void FindWrong() {
    wrong_.clear();
    for (Index row = 0; row < moves_.size(); ++row) {
      const double bound = bounds_[row];
      if (At(row) == 0) {
        if (hold_[row] > bound * (1 + kRounding)) wrong_.emplace_back(row, 1);
        if (hold_[row] < -bound * (1 + kRounding)) wrong_.emplace_back(row, -1);
      } else if (At(row) * w_[row] > kRounding * by_effort_(row, row) * bound) {
        wrong_.emplace_back(row, 0);
      }
    }
  }

  const MatrixXd& by_effort_;
  const VectorXd& moves_;
  const VectorXd& bounds_;
  VectorXd& hold_;
  std::vector<int> at_;  // which bound: -1, 1; 0: none
  std::vector<Index> free_;
  std::vector<std::pair<Index, int>> wrong_;
  VectorXd w_;
};

}  // namespace

void FindHolds(const MatrixXd& by_effort, const VectorXd& moves, const VectorXd& bounds,
               VectorXd* hold) {
  Holds(by_effort, moves, bounds, hold).Find();
}

}  // namespace tcs
