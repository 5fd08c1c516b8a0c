#include "simbody_bridge/contact_forces.h"

#include <algorithm>
#include <tuple>

namespace tcs {
namespace {

// Without negative zeros.
std::array<double, 3> Opposite(const std::array<double, 3>& v) {
  return {0 - v[0], 0 - v[1], 0 - v[2]};
}

// Which of two comes first: links that move, then links that do not, then fixtures.
auto RankOf(const ForestShape& shape) {
  return std::tuple(shape.link < 0, shape.body == kWorldBody, shape.link, shape.fixture);
}

}  // namespace

void AppendForces(const Forest& forest, std::span<const ShapeContact> found,
                  std::vector<ContactForce>* contacts) {
  for (const ShapeContact& contact : found) {
    if (contact.force_n == std::array<double, 3>{}) continue;
    const ForestShape& a = forest.shapes[contact.first];
    const ForestShape& b = forest.shapes[contact.second];
    const bool is_in_order = RankOf(a) < RankOf(b);
    const ForestShape &first = is_in_order ? a : b, &second = is_in_order ? b : a;
    contacts->push_back({first.link, second.link, second.fixture, contact.point_m,
                         is_in_order ? contact.normal : Opposite(contact.normal),
                         is_in_order ? contact.force_n : Opposite(contact.force_n)});
  }
}

void SortForces(std::vector<ContactForce>* contacts) {
  std::ranges::stable_sort(*contacts, {}, [](const ContactForce& contact) {
    return std::tuple(contact.first, contact.second < 0, contact.second, contact.fixture);
  });
}

}  // namespace tcs
