#include "simbody_bridge/simbody/tree/mimics.h"

namespace tcs {

Eigen::Index Reduce(const SimbodyTree& tree, std::vector<ReducedSpeed>* reduced) {
  const SimTK::State& state = tree.evaluated();
  const Forest& forest = tree.forest();
  const auto all = static_cast<std::size_t>(state.getNU());
  std::vector<int> leader(all, -1);
  reduced->assign(all, {});
  for (const ForestJoint& joint : forest.joints) {
    if (joint.leader < 0) continue;
    const int body = forest.joints[static_cast<std::size_t>(joint.leader)].body;
    const auto own = static_cast<std::size_t>(int{tree.body(joint.body).getFirstUIndex(state)});
    leader[own] = tree.body(body).getFirstUIndex(state);
    (*reduced)[own].times = joint.joint->mimic->multiplier;
  }
  Eigen::Index columns = 0;
  for (std::size_t u = 0; u < all; ++u) {
    if (leader[u] < 0) (*reduced)[u].of = columns++;
  }
  for (std::size_t u = 0; u < all; ++u) {
    if (leader[u] < 0) continue;
    (*reduced)[u].of = (*reduced)[static_cast<std::size_t>(leader[u])].of;
    (*reduced)[u].is_follower = true;
  }
  return columns;
}

void Reduce(const SimbodyTree& tree, Eigen::MatrixXd* reduction) {
  std::vector<ReducedSpeed> reduced;
  const Eigen::Index columns = Reduce(tree, &reduced);
  reduction->setZero(static_cast<Eigen::Index>(reduced.size()), columns);
  for (std::size_t u = 0; u < reduced.size(); ++u) {
    (*reduction)(static_cast<Eigen::Index>(u), reduced[u].of) = reduced[u].times;
  }
}

}  // namespace tcs
