#include "coordinator/world/contact_lines.h"

#include "coordinator/world/csv_row.h"
#include "coordinator/world/link_lines.h"

namespace tcs {

ContactLines::ContactLines(const WorldSpec& world) : links_(NamesOfLinks(world)) {
  for (const Shape& fixture : world.fixtures) fixtures_.push_back(fixture.name);
}

void ContactLines::Write(Dynamics& dynamics, CsvFile* file) {
  dynamics.ReadContacts(dynamics.Now(), &contacts_);
  if (contacts_.empty()) return;
  const CsvTime time_s(dynamics.Now());
  for (const ContactForce& contact : contacts_) {
    const auto first = static_cast<std::size_t>(contact.first);
    const std::string& second = contact.second >= 0
                                    ? links_[static_cast<std::size_t>(contact.second)]
                                    : fixtures_[static_cast<std::size_t>(contact.fixture)];
    const auto& [x, y, z] = contact.point_m;
    const auto& [nx, ny, nz] = contact.normal;
    const auto& [fx, fy, fz] = contact.force_n;
    file->Line(time_s.text(), links_[first], second, x, y, z, nx, ny, nz, fx, fy, fz);
  }
}

}  // namespace tcs
