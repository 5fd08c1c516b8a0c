// Prints where main's stack is.
#include <cstdio>

int main() {
  const int here = 0;
  printf("%p\n", static_cast<const void*>(&here));
  return 0;
}
