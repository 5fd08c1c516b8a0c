// Decides which requests the server of a live page answers: those of programs that were given its
// address, which has a secret in it, and not those of a page of another origin that a browser has
// open beside it.
//
// Pure, and thread-safe: an Auth does not change once it is made.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tcs {

// The comparison takes a time that depends on the length of `secret` alone, whatever is given.
[[nodiscard]] bool EqualsSecret(std::string_view given, std::string_view secret);

// 128 bits of the kernel's, in 32 hexadecimal digits. Empty if the kernel has none to give.
[[nodiscard]] std::string MakeToken();

class Auth {
 public:
  // The parts of a request that decide. Origin: empty if the browser, or another program, sends
  // none.
  struct Request {
    std::string_view path;
    std::string_view host, origin;
  };

  // The server listens at `address`, a number, and at `port`.
  Auth(std::string token, std::string address, int port);

  // The part of the path behind the token; none where the request is refused.
  [[nodiscard]] std::optional<std::string_view> Authorize(const Request& request) const;

  // "http://127.0.0.1:40000/0123.../".
  [[nodiscard]] std::string url() const;

 private:
  bool IsOurHost(std::string_view host) const;
  bool IsOurOrigin(std::string_view origin, std::string_view host) const;

  std::string token_, address_, port_;
  bool is_loopback_;
};

}  // namespace tcs
