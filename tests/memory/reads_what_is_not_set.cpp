// A program that decides by a value that nobody has set: valgrind has to end it with an error.
#include <memory>

int main() {
  const std::unique_ptr<volatile int[]> values(new volatile int[4]);
  return values[2] == 1234567 ? 1 : 0;
}
