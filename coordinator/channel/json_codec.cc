#include "coordinator/channel/json_codec.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>

namespace tcs {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

constexpr std::string_view kExample = R"({"force": [0, 0, 0], "torque": [0, 0, 0]})";
constexpr std::size_t kLongestQuote = 40;

// Somebody else's text, short and printable.
std::string Quote(const std::string& text) {
  const bool cut = text.size() > kLongestQuote;
  return Json(cut ? text.substr(0, kLongestQuote) + "..." : text)
      .dump(-1, ' ', true, Json::error_handler_t::replace);
}

DecodeError Mistake(const std::string& what) {
  return DecodeError{"the command datagram " + what + "; send an object like " +
                     std::string(kExample)};
}

// Three finite numbers; none if `value` is anything else.
std::optional<std::array<double, 3>> Vector3(const Json& value) {
  if (!value.is_array() || value.size() != 3) return std::nullopt;
  std::array<double, 3> vector{};
  for (std::size_t i = 0; i < vector.size(); ++i) {
    if (!value[i].is_number()) return std::nullopt;
    vector[i] = value[i].get<double>();
    if (!std::isfinite(vector[i])) return std::nullopt;
  }
  return vector;
}

}  // namespace

std::string EncodeSensorDatagram(VirtualTime time, std::span<const NamedBodyState> bodies) {
  OrderedJson datagram;
  // Divided, not multiplied by 1e-9: the double nearest to the decimal fraction.
  datagram["time"] = static_cast<double>(time.ns()) / 1e9;
  datagram["frame_id"] = "world";
  OrderedJson& states = datagram["bodies"] = OrderedJson::object();
  for (const NamedBodyState& body : bodies) {
    OrderedJson& state = states[std::string(body.name)];
    state["position"] = body.state.position_m;
    state["orientation"] = body.state.orientation_xyzw;
    state["linear_velocity"] = body.state.linear_velocity_mps;
    state["angular_velocity"] = body.state.angular_velocity_radps;
  }
  return datagram.dump();
}

std::variant<Wrench, DecodeError> DecodeCommandDatagram(std::string_view datagram) {
  Json command;
  try {
    command = Json::parse(datagram);
  } catch (const Json::parse_error& error) {
    return Mistake("is not valid JSON at byte " + std::to_string(error.byte));
  } catch (const Json::out_of_range&) {
    return Mistake("holds a number too large for a double");
  }
  if (!command.is_object()) return Mistake(std::string("is of the type ") + command.type_name());

  Wrench wrench;
  for (const auto& [key, value] : command.items()) {
    const bool is_force = key == "force";
    if (!is_force && key != "torque") {
      return Mistake("has the unknown key " + Quote(key));
    }
    const auto vector = Vector3(value);
    if (!vector) return Mistake("has a " + key + " that is not a list of three finite numbers");
    (is_force ? wrench.force_n : wrench.torque_nm) = *vector;
  }
  return wrench;
}

}  // namespace tcs
