#include "simbody_bridge/joints/branches.h"

#include <vector>

namespace tcs {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// Rows one after the other in which a column is not 0.
struct Run {
  Index first, end;
};

void FindRuns(const double* column, Index size, std::vector<Run>* runs) {
  runs->clear();
  for (Index i = 0; i < size; ++i) {
    if (column[i] == 0) continue;
    const Index first = i;
    while (i < size && column[i] != 0) ++i;
    runs->push_back({first, i});
  }
}

// Takes `share` times a column from another one, in the rows of one run.
void Take(double share, const double* column, Run run, double* from) {
  const Index count = run.end - run.first;
  Eigen::Map<VectorXd>(from + run.first, count) -=
      share * Eigen::Map<const VectorXd>(column + run.first, count);
}

}  // namespace

// The system is L^T D L, with a unit lower triangular L: row k of L is written into column k.
void SolveByBranches(Eigen::MatrixXd* system, VectorXd* x) {
  Eigen::MatrixXd& a = *system;
  std::vector<Run> runs;
  for (Index k = a.rows() - 1; k >= 0; --k) {
    double* column = a.col(k).data();
    FindRuns(column, k, &runs);
    const double by_pivot = 1 / column[k], last = (*x)[k];
    for (std::size_t run = runs.size(); run-- > 0;) {
      for (Index i = runs[run].end - 1; i >= runs[run].first; --i) {
        const double share = column[i] * by_pivot;
        double* from = a.col(i).data();
        for (std::size_t before = 0; before < run; ++before) {
          Take(share, column, runs[before], from);
        }
        Take(share, column, {runs[run].first, i + 1}, from);
        (*x)[i] -= share * last;
        column[i] = share;
      }
    }
  }
  for (Index k = 0; k < a.rows(); ++k) {
    (*x)[k] = (*x)[k] / a(k, k) - a.col(k).head(k).dot(x->head(k));
  }
}

}  // namespace tcs
