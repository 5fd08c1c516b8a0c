// Numbers and objects as the page's scripts read them.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace tcs::report {

// Whole numbers in as few bytes as they need, seven bits each, the lowest first.
void PutNumber(std::string* bytes, std::uint64_t value);
// Whole numbers that may be negative, the sign in the lowest bit.
void PutSigned(std::string* bytes, std::int64_t value);

[[nodiscard]] std::string Base64(const std::string& bytes);

// JSON that may stand in a <script> element.
[[nodiscard]] std::string ForScript(const nlohmann::ordered_json& json);

}  // namespace tcs::report
