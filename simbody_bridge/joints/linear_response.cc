#include "simbody_bridge/joints/linear_response.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <type_traits>
#include <vector>

#include "simbody_bridge/joints/spring_response.h"

namespace tcs {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::array<double, 6> kFactorials = {1, 1, 2, 6, 24, 120};

// phi_2 to phi_5 of `z`, which is not positive.
std::array<double, 4> PhiFrom2(double z) {
  std::array<double, 6> phi{};
  if (z > -1) {
    // The series of phi_5: the next term is below 1e-17.
    double term = 1 / kFactorials[5];
    for (int k = 6; k < 22; ++k) {
      phi[5] += term;
      term *= z / k;
    }
    for (std::size_t k = 5; k > 2; --k) phi[k - 1] = 1 / kFactorials[k - 1] + z * phi[k];
  } else {
    phi[0] = std::exp(z);
    for (std::size_t k = 0; k < 5; ++k) phi[k + 1] = (phi[k] - 1 / kFactorials[k]) / z;
  }
  return {phi[2], phi[3], phi[4], phi[5]};
}

// The sum of shares[i] * B_{first + i} * pushes[i].
VectorXd Answer(const LinearResponse& response, std::size_t first,
                const std::array<const VectorXd*, 3>& pushes) {
  constexpr std::array<double, 3> kShares = {1, 1, 2};
  const DampedModes& modes = *response.modes;
  VectorXd answer = VectorXd::Zero(pushes[0]->size());
  VectorXd by_mode = VectorXd::Zero(modes.rates.size());
  for (std::size_t i = 0; i < 3; ++i) {
    answer += kShares[i] / kFactorials[first + i + 1] * *pushes[i];
    by_mode.array() +=
        kShares[i] * response.of_mode[first + i].array() * (modes.from * *pushes[i]).array();
  }
  answer.noalias() += modes.onto * by_mode;
  return answer;
}

}  // namespace

void FindModes(const MatrixXd& by_mass, const VectorXd& dampers, DampedModes* modes) {
  std::vector<Eigen::Index> damped;
  for (Eigen::Index i = 0; i < dampers.size(); ++i) {
    if (dampers[i] > 0) damped.push_back(i);
  }
  const auto count = static_cast<Eigen::Index>(damped.size());
  modes->rates.resize(count);
  modes->onto.resize(dampers.size(), count);
  modes->from.setZero(count, dampers.size());
  if (damped.empty()) return;
  const VectorXd roots = dampers(damped).cwiseSqrt();
  MatrixXd onto = by_mass(Eigen::all, damped);
  onto *= roots.asDiagonal();
  MatrixXd each = onto(damped, Eigen::all);
  each = roots.asDiagonal() * each;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solved(each);
  modes->rates = solved.eigenvalues().cwiseMax(0);
  modes->onto = onto * solved.eigenvectors();
  for (Eigen::Index i = 0; i < count; ++i) {
    modes->from.col(damped[static_cast<std::size_t>(i)]) =
        roots[i] * solved.eigenvectors().row(i).transpose();
  }
}

// As phi_{k+1}(z) - 1 / (k+1)! = z phi_{k+2}(z).
void FindResponse(const DampedModes& modes, double seconds, LinearResponse* response) {
  response->seconds = seconds;
  response->modes = &modes;
  for (VectorXd& of_mode : response->of_mode) of_mode.resize(modes.rates.size());
  for (Eigen::Index i = 0; i < modes.rates.size(); ++i) {
    const std::array<double, 4> phi = PhiFrom2(-seconds * modes.rates[i]);
    for (std::size_t k = 0; k < 4; ++k) response->of_mode[k][i] = -seconds * phi[k];
  }
}

VectorXd LinearResponse::Way(const VectorXd& f0, const VectorXd& f1, const VectorXd& f2) const {
  if (modes != nullptr) return seconds * seconds * Answer(*this, 1, {&f0, &f1, &f2});
  return seconds * seconds * (b[1] * f0 + b[2] * f1 + 2 * (b[3] * f2));
}

VectorXd LinearResponse::Speed(const VectorXd& f0, const VectorXd& f1, const VectorXd& f2) const {
  if (modes != nullptr) return seconds * Answer(*this, 0, {&f0, &f1, &f2});
  return seconds * (b[0] * f0 + b[1] * f1 + 2 * (b[2] * f2));
}

void FindResponse(const MatrixXd& stiffness, const MatrixXd& damping, double seconds,
                  LinearResponse* whole, LinearResponse* half) {
  whole->seconds = seconds;
  whole->modes = nullptr;
  if (half != nullptr) {
    half->seconds = seconds / 2;
    half->modes = nullptr;
  }
  const auto find = [&]<int kSize>(std::integral_constant<int, kSize>) {
    SpringResponse<kSize>(stiffness, damping, seconds).Find(whole, half);
  };
  const Eigen::Index size = stiffness.rows();
  if (size <= 2) return find(std::integral_constant<int, 2>());
  if (size <= 4) return find(std::integral_constant<int, 4>());
  if (size <= 6) return find(std::integral_constant<int, 6>());
  if (size <= 8) return find(std::integral_constant<int, 8>());
  if (size <= 10) return find(std::integral_constant<int, 10>());
  find(std::integral_constant<int, Eigen::Dynamic>());
}

}  // namespace tcs
