// Coulomb's friction of several joints at once: each one holds its joint with whatever that takes,
// up to a bound, and with the bound against the motion where it slides. Pure.
#pragma once

#include <Eigen/Core>

namespace tcs {

// Finds the efforts `hold` within their bounds that lead to the speeds (or accelerations)
// w = moves + by_effort * hold such that w is 0 where an effort is within its bound, at least 0
// where it is at the lower one and at most 0 where it is at the upper one. `by_effort` is symmetric
// and positive definite, which makes them unique (a box-constrained linear complementarity problem;
// Júdice and Pires, Computers & Operations Research 19, 1992).
void FindHolds(const Eigen::MatrixXd& by_effort, const Eigen::VectorXd& moves,
               const Eigen::VectorXd& bounds, Eigen::VectorXd* hold);

}  // namespace tcs
