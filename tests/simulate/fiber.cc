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
  getcontext(&inside_);
  inside_.uc_stack.ss_sp = stack_.get();
  inside_.uc_stack.ss_size = kStackSize;
  inside_.uc_link = nullptr;
  const auto address = reinterpret_cast<std::uintptr_t>(this);
  makecontext(&inside_, reinterpret_cast<void (*)()>(Begin), 2,
              static_cast<unsigned>(address >> 32), static_cast<unsigned>(address));
}

void Fiber::Enter() { swapcontext(&outside_, &inside_); }
void Fiber::Leave() { swapcontext(&inside_, &outside_); }

}  // namespace tcs::simulate
