// The C library's check of longjmp forbids jumps from stack to stack.
#undef _FORTIFY_SOURCE

#include "tests/simulate/fiber.h"

#include <cstdint>
#include <cstdlib>
#include <utility>

namespace tcs::simulate {

// makecontext passes numbers of 32 bits.
void Fiber::Begin(unsigned upper, unsigned lower) {
  const auto address = std::uintptr_t{upper} << 32 | lower;
  reinterpret_cast<Fiber*>(address)->body_();
  std::abort();
}

Fiber::Fiber(std::function<void()> body)
    : body_(std::move(body)), stack_(std::make_unique_for_overwrite<char[]>(kStackSize)) {
  getcontext(&begin_);
  begin_.uc_stack.ss_sp = stack_.get();
  begin_.uc_stack.ss_size = kStackSize;
  begin_.uc_link = nullptr;
  const auto address = reinterpret_cast<std::uintptr_t>(this);
  makecontext(&begin_, reinterpret_cast<void (*)()>(Begin), 2, static_cast<unsigned>(address >> 32),
              static_cast<unsigned>(address));
}

// Each swapcontext would ask the kernel for the mask of signals, which is always the same here.
void Fiber::Enter() {
  if (_setjmp(entered_) != 0) return;
  if (std::exchange(has_begun_, true)) _longjmp(inside_, 1);
  swapcontext(&outside_, &begin_);
}

void Fiber::Leave() {
  if (_setjmp(inside_) == 0) _longjmp(entered_, 1);
}

}  // namespace tcs::simulate
