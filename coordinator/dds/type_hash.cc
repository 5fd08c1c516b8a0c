#include "coordinator/dds/type_hash.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <openssl/sha.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include "coordinator/dds/message_fields.h"
#include "shm/check.h"

namespace tcs::dds {
namespace {

constexpr std::string_view kKey = "typehash=", kPrefix = "RIHS01_";

// The numbers of type_description_interfaces/msg/FieldType.
constexpr int kNested = 1, kBoundedString = 21, kArray = 48, kUnboundedSequence = 144;
const std::map<std::string_view, int>& Numbers() {
  static const std::map<std::string_view, int> numbers = {
      {"int8", 2},   {"uint8", 3}, {"int16", 4},  {"uint16", 5},   {"int32", 6},
      {"uint32", 7}, {"int64", 8}, {"uint64", 9}, {"float32", 10}, {"float64", 11},
      {"bool", 15},  {"byte", 16}, {"string", 17}};
  return numbers;
}

const MessageFields* Find(std::string_view type) {
  for (const auto& messages : {KnownMessages(), DiscoveryMessages()}) {
    const auto found = std::ranges::find(messages, type, &MessageFields::type);
    if (found != messages.end()) return &*found;
  }
  return nullptr;
}

// "std_msgs/Header" as ROS 2 has it in full.
std::string InFull(std::string_view type) {
  const std::size_t slash = type.find('/');
  return fmt::format("{}/msg/{}", type.substr(0, slash), type.substr(slash + 1));
}

int NumberIn(std::string_view digits) {
  int number = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return number;
}

struct Field {
  std::string_view name;
  int type_id = 0, capacity = 0, string_capacity = 0;
  std::string nested;  // "std_msgs/Header"; empty: a plain type
};

// None: the line is a constant.
std::optional<Field> FieldIn(std::string_view line, std::string_view package) {
  const std::size_t space = line.find(' ');
  Field field{.name = line.substr(space + 1)};
  if (field.name.find('=') != std::string_view::npos) return std::nullopt;
  std::string_view type = line.substr(0, space);
  int shape = 0;
  if (const std::size_t bracket = type.find('['); bracket != std::string_view::npos) {
    field.capacity = NumberIn(type.substr(bracket + 1));
    shape = field.capacity > 0 ? kArray : kUnboundedSequence;
    type = type.substr(0, bracket);
  }
  constexpr std::string_view kBound = "string<=";
  if (const auto plain = Numbers().find(type); plain != Numbers().end()) {
    field.type_id = plain->second;
  } else if (type.starts_with(kBound)) {
    field.type_id = kBoundedString;
    field.string_capacity = NumberIn(type.substr(kBound.size()));
  } else {
    field.type_id = kNested;
    field.nested = type.find('/') != std::string_view::npos ? std::string(type)
                                                            : fmt::format("{}/{}", package, type);
  }
  field.type_id += shape;
  return field;
}

// The description of one type; the types that its fields are of are added to `nested`.
std::string Describe(std::string_view type, std::set<std::string>* nested) {
  const MessageFields* message = Find(type);
  TCS_CHECK(message != nullptr);
  std::string fields;
  for (std::string_view rest = message->text; !rest.empty();) {
    const std::size_t end = rest.find('\n');
    const auto field = FieldIn(rest.substr(0, end), type.substr(0, type.find('/')));
    rest.remove_prefix(end + 1);
    if (!field.has_value()) continue;
    if (!field->nested.empty()) nested->insert(field->nested);
    fmt::format_to(std::back_inserter(fields),
                   R"({}{{"name": "{}", "type": {{"type_id": {}, "capacity": {}, )"
                   R"("string_capacity": {}, "nested_type_name": "{}"}}}})",
                   fields.empty() ? "" : ", ", field->name, field->type_id, field->capacity,
                   field->string_capacity, field->nested.empty() ? "" : InFull(field->nested));
  }
  return fmt::format(R"({{"type_name": "{}", "fields": [{}]}})", InFull(type), fields);
}

// The description with all types that the type consists of, in alphabetical order.
std::string DescribeInFull(std::string_view type) {
  std::set<std::string> pending;
  const std::string own = Describe(type, &pending);
  std::map<std::string, std::string> described;
  while (!pending.empty()) {
    const std::string next = pending.extract(pending.begin()).value();
    if (!described.contains(next)) described[next] = Describe(next, &pending);
  }
  std::string referenced;
  for (const auto& [name, description] : described) {
    referenced += (referenced.empty() ? "" : ", ") + description;
  }
  return fmt::format(R"({{"type_description": {}, "referenced_type_descriptions": [{}]}})", own,
                     referenced);
}

// In 64 hexadecimal digits.
std::string Sha256(const std::string& text) {
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest;
  SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest.data());
  return fmt::format("{:02x}", fmt::join(digest, ""));
}

}  // namespace

std::string TypeHashOf(std::string_view type, RosRelease release) {
  constexpr std::string_view kFolder = "/msg/";
  const std::size_t at = type.find(kFolder);
  if (release == RosRelease::kHumble || at == std::string_view::npos) return {};
  const std::string name =
      fmt::format("{}/{}", type.substr(0, at), type.substr(at + kFolder.size()));
  if (Find(name) == nullptr) return {};
  return fmt::format("{}{}", kPrefix, Sha256(DescribeInFull(name)));
}

std::string UserDataOf(std::string_view type, RosRelease release) {
  const std::string hash = TypeHashOf(type, release);
  return hash.empty() ? hash : UserDataWith(hash);
}

std::string UserDataWith(std::string_view hash) { return fmt::format("{}{};", kKey, hash); }

std::string TypeHashIn(std::string_view user_data) {
  // Keys and values, each pair with a semicolon behind it.
  for (std::size_t end; (end = user_data.find(';')) != std::string_view::npos;) {
    std::string_view value = user_data.substr(0, end);
    user_data.remove_prefix(end + 1);
    if (!value.starts_with(kKey)) continue;
    value.remove_prefix(kKey.size());
    const bool is_hash =
        value.starts_with(kPrefix) && value.size() == kPrefix.size() + 64 &&
        value.find_first_not_of("0123456789abcdef", kPrefix.size()) == std::string_view::npos;
    return is_hash ? std::string(value) : std::string();
  }
  return {};
}

}  // namespace tcs::dds
