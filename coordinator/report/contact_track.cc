#include "coordinator/report/contact_track.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "coordinator/report/bytes.h"

namespace tcs::report {
namespace {

using Json = nlohmann::ordered_json;
using Point = ContactTrack::Point;

// A number has 16 bits over its range, as in tracks, but is no finer than anybody sees.
constexpr double kStepsOfTrack = 65'535, kLeastStepM = 1e-4, kLeastStepN = 1e-3;
constexpr std::size_t kNumbers = 6;
constexpr std::size_t kMostStride = 1 << 16;

double NumberOf(const Point& point, std::size_t i) {
  return i < 3 ? point.point_m[i] : point.force_n[i - 3];
}

double SizeOf(const std::array<double, 3>& v) { return std::hypot(v[0], v[1], v[2]); }

// The sum of two forces of a pair, where they are in the mean.
void AddTo(Point* sum, const Point& more) {
  const double weight_n = sum->weight_n + more.weight_n;
  for (std::size_t i = 0; i < 3; ++i) {
    const double moment = sum->point_m[i] * sum->weight_n + more.point_m[i] * more.weight_n;
    if (weight_n > 0) sum->point_m[i] = moment / weight_n;
    sum->force_n[i] += more.force_n[i];
  }
  sum->weight_n = weight_n;
}

// The point of the wanted pair at the wanted moment, which comes last among `points`; null where
// there is none.
Point* PointOf(std::vector<Point>* points, const Point& wanted) {
  for (auto point = points->rbegin(); point != points->rend() && point->moment == wanted.moment;
       ++point) {
    if (point->pair == wanted.pair) return &*point;
  }
  return nullptr;
}

void AddSum(std::vector<Point>* points, const Point& point) {
  if (Point* sum = PointOf(points, point)) {
    AddTo(sum, point);
  } else {
    points->push_back(point);
  }
}

}  // namespace

void ContactTrack::Add(std::size_t moment, const Pair& pair, const std::array<double, 3>& point_m,
                       const std::array<double, 3>& force_n) {
  const bool is_past = !points_.empty() && moment < points_.back().moment;
  if (is_past || moment % stride_ != 0) return;
  const auto [known, is_new] = pair_of_.try_emplace({pair.first, pair.second}, pairs_.size());
  if (is_new) pairs_.push_back(pair);
  const Point point{moment, known->second, point_m, force_n, SizeOf(force_n)};
  if (has_sums_) {
    AddSum(&points_, point);
  } else {
    points_.push_back(point);
  }
  while (points_.size() > most_points_ && stride_ < kMostStride) MakeCoarser();
  if (points_.size() > most_points_)
    points_.pop_back();  // more things touch than there is room for
}

void ContactTrack::MakeCoarser() {
  if (!has_sums_) {
    has_sums_ = true;
    std::vector<Point> sums;
    for (const Point& point : points_) AddSum(&sums, point);
    points_ = std::move(sums);
  } else {
    stride_ *= 2;
    KeepMultiplesOf(stride_);
  }
}

void ContactTrack::KeepMultiplesOf(std::size_t stride) {
  std::erase_if(points_, [stride](const Point& point) { return point.moment % stride != 0; });
}

void ContactTrack::Thin() {
  KeepMultiplesOf(2);
  for (Point& point : points_) point.moment /= 2;
  stride_ = std::max<std::size_t>(1, stride_ / 2);
}

ContactTrack ContactTrack::Part(std::size_t begin, std::size_t end) const {
  ContactTrack part(most_points_);
  part.pairs_ = pairs_;
  part.stride_ = stride_;
  part.has_sums_ = has_sums_;
  const auto from = std::ranges::lower_bound(points_, begin, {}, &Point::moment);
  const auto to = std::ranges::lower_bound(points_, end, {}, &Point::moment);
  part.points_.assign(from, to);
  for (Point& point : part.points_) point.moment -= begin;
  return part;
}

Json ToJson(const ContactTrack& contacts, std::size_t moments) {
  const std::vector<Point>& points = contacts.points();
  if (points.empty()) return {};
  std::array<double, kNumbers> least{}, step{};
  for (std::size_t i = 0; i < kNumbers; ++i) {
    const auto number = [i](const Point& point) { return NumberOf(point, i); };
    const auto [low, high] = std::ranges::minmax_element(points, {}, number);
    least[i] = number(*low);
    step[i] =
        std::max(i < 3 ? kLeastStepM : kLeastStepN, (number(*high) - least[i]) / kStepsOfTrack);
  }
  // Of each pair the first contact of a moment is told by how it differs from the pair's first one
  // before, the second one from the second one, and so on.
  std::vector<std::vector<std::array<std::int64_t, kNumbers>>> before(contacts.pairs().size());
  std::string bytes;
  auto point = points.begin();
  for (std::size_t moment = 0; moment < moments; ++moment) {
    const auto end =
        std::find_if(point, points.end(), [moment](const Point& of) { return of.moment > moment; });
    PutNumber(&bytes, static_cast<std::uint64_t>(end - point));
    std::map<std::size_t, std::size_t> seen;
    for (; point != end; ++point) {
      PutNumber(&bytes, point->pair);
      auto& of_pair = before[point->pair];
      const std::size_t number = seen[point->pair]++;
      if (number == of_pair.size()) of_pair.emplace_back();
      for (std::size_t i = 0; i < kNumbers; ++i) {
        const std::int64_t now = std::llround((NumberOf(*point, i) - least[i]) / step[i]);
        PutSigned(&bytes, now - of_pair[number][i]);
        of_pair[number][i] = now;
      }
    }
  }
  Json pairs = Json::array();
  for (const ContactTrack::Pair& pair : contacts.pairs()) {
    pairs.push_back({pair.first, pair.second, pair.second_moves});
  }
  return {{"stride", contacts.stride()},
          {"sums", contacts.has_sums()},
          {"pairs", std::move(pairs)},
          {"least", least},
          {"step", step},
          {"data", Base64(bytes)}};
}

}  // namespace tcs::report
