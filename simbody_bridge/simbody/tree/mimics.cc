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

void ReduceSystem(std::span<const ReducedSpeed> reduced, Eigen::Index count,
                  const Eigen::MatrixXd& mass, const Eigen::VectorXd& forces,
                  Eigen::MatrixXd* reduced_mass, Eigen::VectorXd* reduced_forces) {
  reduced_mass->setZero(count, count);
  reduced_forces->setZero(count);
  for (Eigen::Index i = 0; i < forces.size(); ++i) {
    const ReducedSpeed& own = reduced[static_cast<std::size_t>(i)];
    (*reduced_forces)[own.of] += own.times * forces[i];
    for (Eigen::Index k = 0; k < forces.size(); ++k) {
      const ReducedSpeed& other = reduced[static_cast<std::size_t>(k)];
      (*reduced_mass)(other.of, own.of) += other.times * own.times * mass(k, i);
    }
  }
}

Eigen::VectorXd SpreadToAll(std::span<const ReducedSpeed> reduced, const Eigen::VectorXd& of_them) {
  Eigen::VectorXd all(static_cast<Eigen::Index>(reduced.size()));
  for (std::size_t i = 0; i < reduced.size(); ++i) {
    all[static_cast<Eigen::Index>(i)] = reduced[i].times * of_them[reduced[i].of];
  }
  return all;
}

}  // namespace tcs
