// A thread of a simulated program: a stack of its own in this thread of the host's.
#pragma once

#include <setjmp.h>
#include <ucontext.h>

#include <functional>
#include <memory>

namespace tcs::simulate {

class Fiber {
 public:
  // `body` must not return.
  explicit Fiber(std::function<void()> body);
  Fiber(const Fiber&) = delete;
  Fiber& operator=(const Fiber&) = delete;

  // From outside: it runs until it says Leave.
  void Enter();
  // From inside: back to whoever has entered.
  void Leave();

 private:
  static constexpr std::size_t kStackSize = 128 << 10;

  static void Begin(unsigned upper, unsigned lower);

  const std::function<void()> body_;
  const std::unique_ptr<char[]> stack_;
  ucontext_t begin_{}, outside_{};  // for its first entry
  bool has_begun_ = false;
  jmp_buf inside_{}, entered_{};
};

}  // namespace tcs::simulate
