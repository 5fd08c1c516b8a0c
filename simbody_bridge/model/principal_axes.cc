#include "simbody_bridge/model/principal_axes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace tcs {

// By Jacobi's rotations, which find small moments beside large ones exactly.
PrincipalAxes PrincipalAxesOf(const std::array<std::array<double, 3>, 3>& inertia) {
  auto m = inertia;
  std::array<std::array<double, 3>, 3> axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  // in rows
  constexpr int kSweeps = 12;  // rotations converge quadratically: five or six do
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (const auto& [p, q] : {std::pair<std::size_t, std::size_t>{0, 1}, {0, 2}, {1, 2}}) {
      if (m[p][q] == 0) continue;
      const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
      const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
      const double c = 1 / std::sqrt(t * t + 1), s = t * c;
      for (std::size_t k = 0; k < 3; ++k) {
        const double kp = m[k][p], kq = m[k][q];
        m[k][p] = c * kp - s * kq;
        m[k][q] = s * kp + c * kq;
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const double pk = m[p][k], qk = m[q][k];
        m[p][k] = c * pk - s * qk;
        m[q][k] = s * pk + c * qk;
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const double pk = axes[p][k], qk = axes[q][k];
        axes[p][k] = c * pk - s * qk;
        axes[q][k] = s * pk + c * qk;
      }
    }
  }
  std::array<std::size_t, 3> order = {0, 1, 2};
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return m[a][a] < m[b][b]; });
  PrincipalAxes result{};
  for (std::size_t i = 0; i < 3; ++i) {
    result.moments[i] = m[order[i]][order[i]];
    result.axes[i] = axes[order[i]];
  }
  return result;
}

}  // namespace tcs
