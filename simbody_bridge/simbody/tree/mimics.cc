#include "simbody_bridge/simbody/tree/mimics.h"

#include <vector>

namespace tcs {

void Reduce(const SimbodyTree& tree, Eigen::MatrixXd* reduction) {
  const SimTK::State& state = tree.evaluated();
  const Forest& forest = tree.forest();
  const int all = state.getNU();
  std::vector<int> leader(static_cast<std::size_t>(all), -1);
  std::vector<double> multiplier(static_cast<std::size_t>(all), 1);
  for (const ForestJoint& joint : forest.joints) {
    if (joint.leader < 0) continue;
    const int body = forest.joints[static_cast<std::size_t>(joint.leader)].body;
    const auto own = static_cast<std::size_t>(int{tree.body(joint.body).getFirstUIndex(state)});
    leader[own] = tree.body(body).getFirstUIndex(state);
    multiplier[own] = joint.joint->mimic->multiplier;
  }
  std::vector<int> column(static_cast<std::size_t>(all), -1);
  int columns = 0;
  for (int u = 0; u < all; ++u) {
    if (leader[static_cast<std::size_t>(u)] < 0) column[static_cast<std::size_t>(u)] = columns++;
  }
  reduction->setZero(all, columns);
  for (int u = 0; u < all; ++u) {
    const auto i = static_cast<std::size_t>(u);
    const int of = leader[i] < 0 ? column[i] : column[static_cast<std::size_t>(leader[i])];
    (*reduction)(u, of) = multiplier[i];
  }
}

}  // namespace tcs
