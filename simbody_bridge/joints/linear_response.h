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

// Dampers without springs, by the modes in which they let the joints go on: D = onto * from, and
// from * onto is diagonal. For a diagonal of dampers and a mass matrix that is one symmetric
// eigenproblem of as many rows as there are dampers; then all else is a function of single rates.
struct DampedModes {
  Eigen::VectorXd rates;  // 1/s
  Eigen::MatrixXd onto, from;
};

// Finds the modes of the speeds that have dampers: `by_mass` is the inverse of the mass matrix,
// `dampers` are the dampers of each speed, at least 0.
void FindModes(const Eigen::MatrixXd& by_mass, const Eigen::VectorXd& dampers, DampedModes* modes);

// The response to a push that takes `seconds`.
struct LinearResponse {
  double seconds = 0;
  std::array<Eigen::MatrixXd, 4> b;
  // Without springs: B_k is 1 / (k+1)! and what each mode adds. The owner of the modes outlives
  // this.
  const DampedModes* modes = nullptr;
  std::array<Eigen::VectorXd, 4> of_mode;

  Eigen::VectorXd Way(const Eigen::VectorXd& f0, const Eigen::VectorXd& f1,
                      const Eigen::VectorXd& f2) const;
  Eigen::VectorXd Speed(const Eigen::VectorXd& f0, const Eigen::VectorXd& f1,
                        const Eigen::VectorXd& f2) const;
};

// The response of dampers alone, however many speeds there are, in time of their number squared.
void FindResponse(const DampedModes& modes, double seconds, LinearResponse* response);

// The response to a push of `seconds` > 0, and to a push half as long unless `half` is null. NaN
// where numbers are too large.
void FindResponse(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& damping, double seconds,
                  LinearResponse* whole, LinearResponse* half);

}  // namespace tcs
