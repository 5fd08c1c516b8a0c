// Coulomb's friction of several joints at once: the friction of each joint holds it with whatever
// that takes, up to a bound, and acts with the bound against the motion where the joint slides.
// Pure.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tcs {

// Finds the efforts `hold` within their bounds that lead to the speeds (or accelerations)
// w = moves + by_effort * hold such that w is 0 where an effort is within its bound, at least 0
// where it is at the lower one and at most 0 where it is at the upper one. `by_effort` is symmetric
// and positive definite, which makes them unique (a box-constrained linear complementarity problem;
// Júdice and Pires, Computers & Operations Research 19, 1992).
void FindHolds(const Eigen::MatrixXd& by_effort, const Eigen::VectorXd& moves,
               const Eigen::VectorXd& bounds, Eigen::VectorXd* hold);

// The same, for a step that is implicit, of whose speeds `rubbing` have friction: `system` * change
// = `impulses` + hold, where speeds + change is 0 for the speeds whose hold is less than `bounds`
// (impulses, too). `at` says for each speed with friction at which bound it is thought to be
// (-1, 1; 0: it is held), and afterwards at which it is.
void FindHeldChange(const Eigen::MatrixXd& system, const Eigen::VectorXd& impulses,
                    const std::vector<Eigen::Index>& rubbing, const Eigen::VectorXd& speeds,
                    const Eigen::VectorXd& bounds, std::vector<int>* at, Eigen::VectorXd* hold,
                    Eigen::VectorXd* change);

}  // namespace tcs
