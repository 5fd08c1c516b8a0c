// The parts of URDF, as far as tcs understands it: which elements stand in which, with which
// attributes of which kind.
#pragma once

#include <vector>

namespace tcs::urdf_rules {

enum class Kind { kName, kFile, kNumber, kNotNegative, kThree, kThreeNotNegative };

struct Attribute {
  const char* name;
  Kind kind;
  bool is_needed = true;
};

inline constexpr int kAnyNumber = 1 << 30;

struct Rule;
struct Child {
  const Rule* rule;
  int least;
  int most;
};

struct Rule {
  const char* name;
  std::vector<Attribute> attributes;
  std::vector<Child> children{};
  bool has_one_child = false;  // exactly one of `children`
  // Elements that are known, and mean nothing to the physics: looks.
  std::vector<const char*> left_out_silently{};
};

// The elements with a name that people know them by.
extern const Rule kRobot, kLink, kJoint;

}  // namespace tcs::urdf_rules
