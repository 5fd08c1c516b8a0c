#include "coordinator/view/auth.h"

#include <arpa/inet.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <utility>

namespace tcs {

namespace {

bool IsNumber(const std::string& address) {
  in6_addr any;
  return inet_pton(AF_INET, address.c_str(), &any) == 1 ||
         inet_pton(AF_INET6, address.c_str(), &any) == 1;
}

bool IsLoopback(const std::string& address) {
  return address.starts_with("127.") || address == "::1";
}

std::string Bracketed(const std::string& address) {
  return address.find(':') == std::string::npos ? address : "[" + address + "]";
}

}  // namespace

bool EqualsSecret(std::string_view given, std::string_view secret) {
  unsigned difference = given.size() == secret.size() ? 0 : 1;
  for (std::size_t i = 0; i < secret.size(); ++i) {
    const char one = i < given.size() ? given[i] : '\0';
    // The volatile store keeps the compiler from leaving the loop early.
    static_cast<volatile unsigned&>(difference) =
        difference | static_cast<unsigned char>(one ^ secret[i]);
  }
  return difference == 0;
}

std::string MakeToken() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) return {};
  std::string token;
  for (const unsigned char byte : bytes) {
    token += "0123456789abcdef"[byte >> 4];
    token += "0123456789abcdef"[byte & 15];
  }
  return token;
}

Auth::Auth(std::string token, std::string address, int port)
    : token_(std::move(token)),
      address_(std::move(address)),
      port_(std::to_string(port)),
      is_loopback_(IsLoopback(address_)) {}

std::string Auth::url() const {
  const bool is_any = address_ == "0.0.0.0" || address_ == "::";
  return "http://" + (is_any ? "localhost" : Bracketed(address_)) + ":" + port_ + "/" + token_ +
         "/";
}

// The owner of a name can make it stand for this machine (DNS rebinding); a number is what it is. A
// server that listens on this machine alone accepts only loopback numbers, besides localhost.
bool Auth::IsOurHost(std::string_view host) const {
  const std::size_t colon = host.rfind(':');
  if (colon == host.npos || host.substr(colon + 1) != port_) return false;
  std::string name(host.substr(0, colon));
  if (name == "localhost") return true;
  if (name.starts_with('[') && name.ends_with(']')) name = name.substr(1, name.size() - 2);
  return IsNumber(name) && (!is_loopback_ || IsLoopback(name));
}

bool Auth::IsOurOrigin(std::string_view origin, std::string_view host) const {
  constexpr std::string_view kScheme = "http://";
  return origin.starts_with(kScheme) && origin.substr(kScheme.size()) == host;
}

std::optional<std::string_view> Auth::Authorize(const Request& request) const {
  if (!IsOurHost(request.host)) return {};
  // A browser names the origin of each request that changes something.
  if (!request.origin.empty() && !IsOurOrigin(request.origin, request.host)) return {};
  const std::string_view path = request.path;
  if (!path.starts_with('/')) return {};
  const std::size_t end = std::min(path.find('/', 1), path.size());
  const bool is_known = EqualsSecret(path.substr(1, end - 1), token_);
  if (!is_known || end == path.size()) return {};
  return path.substr(end + 1);
}

}  // namespace tcs
