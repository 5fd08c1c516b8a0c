// Drives a rover to and fro between two places, around whatever its lidar sees: for each scan it
// looks how all arcs would end that the rover can drive, and takes the best one (a dynamic window).
//
//   local_planner [NAME]     NAME: what its sockets' names begin with, else "rover"
//   in   NAME/scan   {"angle_min": rad, "angle_increment": rad, "ranges": [m or null, ...],
//                    "time": s}
//        NAME/pose   {"position": [...], "orientation": [...]}
//   out  NAME/drive  {"linear": [m/s, 0, 0], "angular": [0, 0, rad/s]}
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "examples/common/datagrams.h"
#include "examples/common/ticks.h"
#include "examples/rover/geometry.h"

namespace rover {

using examples::Json;
using examples::Seconds;
using examples::Socket;
using examples::Ticks;

namespace {

constexpr Point kPlaces[] = {{6.2, 0}, {-6.2, 0}};
constexpr double kArrivedM = 0.6;

constexpr double kFastestMps = 1.2, kBackMps = -0.8, kTurnRadps = 2.4;
constexpr int kSpeeds = 21, kTurns = 41;
constexpr double kLookAheadS = 1.5, kStepS = 0.05;
// The rover, seen from its axle, where its lidar is; and how far it keeps away at least and at
// best.
constexpr double kFrontM = 0.1, kRearM = -0.3, kHalfWidthM = 0.2, kLeastM = 0.08, kBestM = 0.7;
// Points further apart are not of one thing; people are no broader, and walk no faster.
constexpr double kGapM = 0.35, kPersonM = 0.6, kWalkMps = 2;

// What the lidar sees, in the rover's frame, and how it moves there while the rover stands.
struct Obstacle {
  Point at, velocity;
};

// The points of a scan that stand beside each other: a person, or a wall.
struct Cluster {
  std::vector<Point> points;
  Point middle;  // in the world

  double Breadth() const {
    return std::hypot(points.front().x - points.back().x, points.front().y - points.back().y);
  }
};

std::vector<Cluster> ClustersOf(const Json& scan, const Place& place) {
  std::vector<Cluster> clusters;
  double angle = scan.at("angle_min");
  for (const Json& range : scan.at("ranges")) {
    if (range.is_number() && range > 0) {
      const double far_m = range;
      const Point point{far_m * std::cos(angle), far_m * std::sin(angle)};
      const bool is_new =
          clusters.empty() || std::hypot(point.x - clusters.back().points.back().x,
                                         point.y - clusters.back().points.back().y) > kGapM;
      if (is_new) clusters.emplace_back();
      clusters.back().points.push_back(point);
    }
    angle += scan.at("angle_increment").get<double>();
  }
  for (Cluster& cluster : clusters) {
    Point sum;
    for (const Point& point : cluster.points) sum = {sum.x + point.x, sum.y + point.y};
    const auto count = static_cast<double>(cluster.points.size());
    cluster.middle = InWorld(place, {sum.x / count, sum.y / count});
  }
  return clusters;
}

// What is as broad as a person has come from where one was in the scan before.
std::vector<Obstacle> ObstaclesOf(const std::vector<Cluster>& now,
                                  const std::vector<Cluster>& before, double seconds,
                                  const Place& place) {
  std::vector<Obstacle> obstacles;
  for (const Cluster& cluster : now) {
    Point moved;  // in the world
    double least = kWalkMps * seconds + 0.1;
    for (const Cluster& earlier : before) {
      const Point way{cluster.middle.x - earlier.middle.x, cluster.middle.y - earlier.middle.y};
      if (std::max(cluster.Breadth(), earlier.Breadth()) > kPersonM) continue;
      if (std::hypot(way.x, way.y) > least) continue;
      least = std::hypot(way.x, way.y);
      moved = way;
    }
    const Point velocity = From({0, 0, place.heading}, {moved.x / seconds, moved.y / seconds});
    for (const Point& point : cluster.points) obstacles.push_back({point, velocity});
  }
  return obstacles;
}

// From the rover's sides, where it is at `place` after so many seconds, to the nearest obstacle.
double Clearance(const Place& place, const std::vector<Obstacle>& obstacles, double seconds) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Obstacle& obstacle : obstacles) {
    const Point seen = From(place, {obstacle.at.x + seconds * obstacle.velocity.x,
                                    obstacle.at.y + seconds * obstacle.velocity.y});
    const double dx = std::max({0.0, seen.x - kFrontM, kRearM - seen.x});
    const double dy = std::max(0.0, std::abs(seen.y) - kHalfWidthM);
    nearest = std::min(nearest, dx * dx + dy * dy);
  }
  return std::sqrt(nearest);
}

// How good the arc is; none if it ends at an obstacle.
std::optional<double> Score(const Speed& speed, const std::vector<Obstacle>& obstacles,
                            const Point& goal) {
  // Out of a tight place it may go, and no further in.
  const double least = std::min(kLeastM, Clearance({}, obstacles, 0) - 0.01);
  double clearance = kBestM;
  Place place;
  for (double t = kStepS; t < kLookAheadS; t += kStepS) {
    place = After(place, speed, kStepS);
    clearance = std::min(clearance, Clearance(place, obstacles, t));
    if (clearance < least) return std::nullopt;
  }
  const Point left = From(place, goal);
  const double off = std::abs(std::atan2(left.y, left.x));  // from the way to the goal
  return -std::hypot(left.x, left.y) - 0.6 * off + 3 * clearance + 0.1 * speed.ahead_mps;
}

Speed BestArc(const std::vector<Obstacle>& obstacles, const Point& goal) {
  Speed best;
  double best_score = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < kSpeeds; ++i) {
    for (int k = 0; k < kTurns; ++k) {
      const Speed speed{kBackMps + (kFastestMps - kBackMps) * i / (kSpeeds - 1),
                        kTurnRadps * (2.0 * k / (kTurns - 1) - 1)};
      const auto score = Score(speed, obstacles, goal);
      if (score && *score > best_score) {
        best_score = *score;
        best = speed;
      }
    }
  }
  return best;
}

void Run(const std::string& name) {
  Socket scans(name + "/scan"), poses(name + "/pose");
  std::vector<Cluster> before;
  double before_s = 0;
  Place place;
  std::size_t next = 0;
  Ticks ticks(100);
  for (;;) {
    ticks.WaitForNext();
    if (const auto pose = poses.ReceiveNewest()) place = PlaceOf(*pose);
    const auto scan = scans.ReceiveNewest();
    if (!scan) continue;
    const double start_s = Seconds();
    Point goal = From(place, kPlaces[next]);
    if (std::hypot(goal.x, goal.y) < kArrivedM) {
      next = (next + 1) % std::size(kPlaces);
      goal = From(place, kPlaces[next]);
    }
    const std::vector<Cluster> now = ClustersOf(*scan, place);
    const double now_s = scan->at("time");
    const Speed best = BestArc(ObstaclesOf(now, before, now_s - before_s, place), goal);
    before = now;
    before_s = now_s;
    scans.Send(name + "/drive",
               {{"linear", {best.ahead_mps, 0, 0}}, {"angular", {0, 0, best.turn_radps}}});
    std::printf("%.3f s: at %.2f %.2f, %.2f m/s, %.2f rad/s, after %.1f ms\n", start_s, place.x,
                place.y, best.ahead_mps, best.turn_radps, 1e3 * (Seconds() - start_s));
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace rover

int main(int argc, char** argv) { rover::Run(argc > 1 ? argv[1] : "rover"); }
