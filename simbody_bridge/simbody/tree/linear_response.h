// How springs and dampers answer a push, in closed form: x'' = f(t) - K x - D x', from x = x' = 0
// on. However stiff they are, and however long they are pushed, no steps are taken on the way.
//
// With the push f = f0 + f1 s + f2 s^2, where s = t / h grows from 0 to 1, they are after h at
//   x = h^2 (B1 f0 + B2 f1 + 2 B3 f2) with x' = h (B0 f0 + B1 f1 + 2 B2 f2),
// where B_k is the upper right block of phi_k([[0, 1], [-h^2 K, -h D]]), of the phi functions of
// exponential integrators (Hochbruck and Ostermann, Exponential integrators, Acta Numerica 19,
// 2010). Without springs and dampers B_k is 1 / (k+1)!.
#pragma once

#include <Eigen/Core>
#include <array>

namespace tcs {

// To a push that takes `seconds`.
struct LinearResponse {
  double seconds = 0;
  std::array<Eigen::MatrixXd, 4> b;

  Eigen::VectorXd Way(const Eigen::VectorXd& f0, const Eigen::VectorXd& f1,
                      const Eigen::VectorXd& f2) const {
    return seconds * seconds * (b[1] * f0 + b[2] * f1 + 2 * (b[3] * f2));
  }
  Eigen::VectorXd Speed(const Eigen::VectorXd& f0, const Eigen::VectorXd& f1,
                        const Eigen::VectorXd& f2) const {
    return seconds * (b[0] * f0 + b[1] * f1 + 2 * (b[2] * f2));
  }
};

// Finds responses, by their series for a fraction of the time and by doubling that (Skaflestad and
// Wright, The scaling and modified squaring method for matrix functions related to the exponential,
// Applied Numerical Mathematics 59, 2009). Memory alone: what it finds depends on the arguments.
class ResponseFinder {
 public:
  // To a push of `seconds` > 0, and to one half as long unless `half` is null. NaN where numbers
  // are too large.
  void Find(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& damping, double seconds,
            LinearResponse* whole, LinearResponse* half);

 private:
  void Begin(int size);
  void Double();

  // In units of the time that is reached.
  Eigen::MatrixXd stiffness_, damping_;
  // The upper left block of the exponential, and the upper right ones of all.
  Eigen::MatrixXd a_;
  std::array<Eigen::MatrixXd, 4> b_, doubled_;
  Eigen::MatrixXd next_, over_next_, term_;
};

}  // namespace tcs
